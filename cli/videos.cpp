#include "cli/videos.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include "cli/command_line.h"
#include "cli/interrupt.h"
#include "core/base/folder_links.h"
#include "core/base/printable.h"
#include "core/base/text.h"
#include "core/finish/picture.h"
#include "core/image/read_image.h"
#include "core/image/write_image.h"
#include "core/job/output_path.h"

namespace hyades::cli {
namespace {

/// `video` with pictures that are there, where its own are not: those of a job that was rendered
/// whole are gone.
core::VideoDesc with_pictures_at_hand(const core::Job& job, const core::VideoDesc& video,
                                      const core::VideoFrames& frames) {
  core::VideoDesc best = video;
  size_t least = SIZE_MAX;  // its own come first
  for (const std::string& pictures : core::alike_pictures(job, video)) {
    core::VideoDesc other = video;
    other.pictures = pictures;
    const size_t missing = core::missing_pictures(other, frames).size();
    if (missing >= least) continue;
    best = std::move(other);
    least = missing;
    if (least == 0) break;
  }
  return best;
}

/// Why pictures that lie there are none of the video's.
void note_other_pictures(const core::Job& job, const core::VideoDesc& video,
                         const core::VideoFrames& frames) {
  const std::vector<std::string> alike = core::alike_pictures(job, video);
  for (const core::OutputDesc& output : job.outputs) {
    if (std::find(alike.begin(), alike.end(), output.file) != alike.end()) continue;
    core::VideoDesc other = video;
    other.pictures = output.file;
    if (!core::missing_pictures(other, frames).empty()) continue;
    std::fprintf(stderr,
                 "the frames of %s are there, but do not look as the video's pictures shall: in "
                 "tone_map, exposure, denoise or layers they differ\n",
                 core::printable(output.file).c_str());
  }
}

/// Makes those of the video's own pictures that are not there of the frames' EXRs, where all of
/// these are. How many; 0 where there is nothing to make them of.
core::Result<size_t> pictures_of_light(const core::Job& job, const core::VideoDesc& video,
                                       const core::VideoFrames& frames) {
  const core::OutputDesc* light = core::light_of_pictures(job, video);
  if (light == nullptr) return size_t{0};
  const core::OutputDesc* own = core::own_pictures(job, video);
  std::vector<std::pair<std::string, std::string>> missing;  // the light, and its picture
  for (const int32_t number : frames.numbers) {
    const std::string picture = core::output_path(*own, frames.folder, number);
    std::error_code none;
    if (std::filesystem::exists(picture, none)) continue;
    missing.emplace_back(core::output_path(*light, frames.folder, number), picture);
    if (!std::filesystem::exists(missing.back().first, none)) return size_t{0};
  }
  for (const auto& [exr, picture] : missing) {
    const auto image = core::read_image_file(exr);
    if (!image) return image.error();
    const auto texts = core::read_exr_texts(exr);
    if (!texts) return texts.error();
    core::ImageMetadata metadata;
    for (const auto& text : *texts) {
      if (text.first.starts_with("hyades.")) metadata.push_back(text);
    }
    if (auto written = core::write_output(*own, *image, picture, metadata); !written) {
      return written.error();
    }
  }
  return missing.size();
}

/// Whether no link leads the videos, or the pictures that go once they are made, out of the folder.
core::Status stay_in_folder(const core::Job& job, const core::VideoFrames& frames) {
  core::FolderLinks links(frames.folder);
  for (const core::VideoDesc& video : job.videos) {
    std::vector<std::string> paths = core::video_pictures(video, frames);
    paths.push_back(frames.folder + "/" + core::video_file(video, frames));
    for (const std::string& path : paths) {
      if (auto stays = links.check(path); !stays) return stays;
    }
  }
  return {};
}

}  // namespace

bool make_videos(const core::Job& job, const std::string& folder,
                 const std::vector<int32_t>& numbers, bool quiet) {
  const core::VideoFrames frames = core::video_frames(job, folder, numbers);
  if (const auto stay = stay_in_folder(job, frames); !stay) {
    print_error(stay.error());
    return false;
  }
  bool all = true;
  for (const core::VideoDesc& video : job.videos) {
    const std::string file = core::video_file(video, frames);
    const core::VideoDesc at_hand = with_pictures_at_hand(job, video, frames);
    std::error_code none;
    if (!core::missing_pictures(at_hand, frames).empty()) {
      const auto made = pictures_of_light(job, video, frames);
      if (!made) {
        print_error(made.error());
        all = false;
        continue;
      }
      if (!quiet && *made > 0) {
        std::fprintf(stderr, "of %s, which hold the light of its pictures\n",
                     core::light_of_pictures(job, video)->file.c_str());
      }
    }
    const std::vector<std::string> missing = core::missing_pictures(at_hand, frames);
    const std::string gone =
        std::to_string(missing.size()) + (missing.size() == 1 ? " is" : " are");
    if (!missing.empty() && std::filesystem::exists(std::filesystem::path(folder) / file, none)) {
      std::fprintf(stderr,
                   "%s/%s is there, and of the pictures that it is made of %s gone: 'hyades "
                   "render' with --restart makes them anew\n",
                   folder.c_str(), file.c_str(), gone.c_str());
      all = false;
      continue;
    }
    if (!quiet) {
      std::fprintf(stderr, "making %s/%s of %s\n", folder.c_str(), file.c_str(),
                   core::counted(frames.numbers.size(), "frame").c_str());
    }
    core::VideoPatience patience;
    patience.stop = interrupted;
    if (!quiet && at_hand.pictures != video.pictures) {
      std::fprintf(stderr, "of %s, which look the same as its own pictures\n",
                   at_hand.pictures.c_str());
    }
    if (const auto made = core::make_video(at_hand, frames, patience); !made) {
      print_error(made.error());
      if (missing.size() == frames.numbers.size()) note_other_pictures(job, video, frames);
      all = false;
    } else if (!quiet) {
      std::fprintf(stderr, "wrote %s/%s\n", folder.c_str(), file.c_str());
    }
    if (interrupted()) return false;
  }
  return all;
}

void note_no_videos(const core::Job& job, const std::string& folder, const std::string& path) {
  for (const core::VideoDesc& video : job.videos) {
    std::fprintf(stderr,
                 "%s/%s is not made: these are not all of the job's frames. Their pictures are in "
                 "%s.frames; 'hyades video %s --output %s' makes it when all are there, with "
                 "--frames a part of it\n",
                 folder.c_str(), video.file.c_str(), video.file.c_str(),
                 core::printable(core::shell_word(path)).c_str(),
                 core::printable(core::shell_word(folder)).c_str());
  }
}

}  // namespace hyades::cli
