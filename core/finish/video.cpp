#include "core/finish/video.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <system_error>
#include <utility>

#include "core/base/atomic_file.h"
#include "core/base/child_process.h"
#include "core/image/encode_codes.h"
#include "core/image/read_image.h"
#include "core/job/output_path.h"

namespace hyades::core {
namespace {

namespace fs = std::filesystem;

/// Rows of RGB, three bytes a pixel, both sides even.
struct RawPicture {
  std::map<std::string, std::string> texts;  ///< of its header
  int width = 0;
  int height = 0;
  std::vector<std::byte> data;
};

Result<RawPicture> read_picture(const std::string& path) {
  const auto image = read_image_file(path, ColorSpace::linear);
  if (!image) return image.error();
  auto codes = encode_codes(*image, false);
  if (!codes) return codes.error().in(path);
  RawPicture raw;
  if (file_extension(path) == ".png") {  // others say nothing that is asked for
    const auto texts = read_png_texts(path);
    if (!texts) return texts.error();
    raw.texts = {texts->begin(), texts->end()};
  }
  raw.width = image->width + image->width % 2;
  raw.height = image->height + image->height % 2;
  raw.data.reserve(static_cast<size_t>(raw.width) * static_cast<size_t>(raw.height) * 3);
  for (int y = 0; y < raw.height; ++y) {
    for (int x = 0; x < raw.width; ++x) {
      const size_t pixel =
          image->index(std::min(x, image->width - 1), std::min(y, image->height - 1), 0) /
          image->channels.size();
      for (size_t c = 0; c < 3; ++c) {
        const size_t from = codes->channels == 1 ? 0 : c;
        raw.data.push_back(
            std::byte{codes->data[pixel * static_cast<size_t>(codes->channels) + from]});
      }
    }
  }
  return raw;
}

// R'G'B' to Y'CbCr by Rec.709's matrix; the transfer curve stays what it is. The frames say so
// themselves: what encoders are told beside them, ffmpeg 7 overrides with what frames say.
constexpr const char* kToVideo =
    "scale=out_color_matrix=bt709:out_range=tv:flags=bicubic+accurate_rnd+full_chroma_int,"
    "format=yuv420p,"
    "setparams=range=tv:color_primaries=bt709:colorspace=bt709:color_trc=";

/// What the pictures of one video have in common.
constexpr std::array<const char*, 4> kCommon = {"hyades.job", "hyades.samples", "hyades.build",
                                                "hyades.display"};

std::string text_of(const RawPicture& picture, const std::string& name) {
  const auto found = picture.texts.find(name);
  return found == picture.texts.end() ? "" : found->second;
}

/// ffmpeg's name of the transfer curve that the pictures say that they have.
std::string transfer_of(const RawPicture& picture) {
  const std::string transfer = text_of(picture, "hyades.transfer");
  if (transfer == "srgb") return "iec61966-2-1";
  return transfer == "linear" || transfer == "bt709" ? transfer : "unknown";
}

std::map<std::string, std::string> metadata_of(const RawPicture& first) {
  std::string comment;
  for (const auto& [name, value] : first.texts) {
    comment += (comment.empty() ? "" : "; ") + name + ": " + value;
  }
  return {{"title", text_of(first, "hyades.job")}, {"comment", comment}};
}

/// An error where the pictures cannot be of one video.
Status check_alike(const RawPicture& first, const RawPicture& picture, const std::string& path) {
  const auto other = [&](const std::string& what) {
    return Error{fmt::format("{} is of another rendering than the first picture: {}", path, what)};
  };
  if (picture.width != first.width || picture.height != first.height) {
    return other(fmt::format("{} x {} pixels, not {} x {}", picture.width, picture.height,
                             first.width, first.height));
  }
  for (const char* name : kCommon) {
    const std::string is = text_of(picture, name);
    const std::string was = text_of(first, name);
    if (is != was) return other(fmt::format("{} is '{}', not '{}'", name, is, was));
  }
  return {};
}

std::vector<std::string> ffmpeg_arguments(const VideoDesc& video, const VideoFrames& frames,
                                          const RawPicture& first, const std::string& path) {
  const std::string ending = file_extension(video.file);
  std::vector<std::string> words = {"-hide_banner", "-nostdin", "-loglevel", "error", "-y",
                                    // What comes in.
                                    "-f", "rawvideo", "-pix_fmt", "rgb24", "-video_size",
                                    fmt::format("{}x{}", first.width, first.height), "-framerate",
                                    fmt::format("{}", frames.rate), "-i", "pipe:0", "-vf",
                                    kToVideo + transfer_of(first)};
  const auto add = [&](std::initializer_list<std::string> more) {
    words.insert(words.end(), more.begin(), more.end());
  };
  const std::string quality = std::to_string(video.rate_factor);
  if (ending == ".webm") {
    add({"-c:v", "libvpx-vp9", "-crf", quality, "-b:v", "0", "-cpu-used", "2", "-row-mt", "1", "-f",
         "webm"});
  } else {
    add({"-c:v", "libx264", "-preset", "medium", "-crf", quality, "-movflags", "+faststart", "-f",
         ending == ".mov" ? "mov" : "mp4"});
  }
  for (const auto& [name, value] : metadata_of(first)) add({"-metadata", name + "=" + value});
  add({"file:" + path});
  return words;
}

/// Whether ffmpeg gets on: it takes pictures, or what it writes grows.
class Progress {
 public:
  Progress(const ChildProcess& child, std::string path, const VideoPatience& patience)
      : child_(child), path_(std::move(path)), patience_(patience) {}

  Status check() {
    if (patience_.stop && patience_.stop()) return Error{"stopped"};
    std::error_code none;
    const auto size = fs::file_size(path_, none);
    const auto now = std::chrono::steady_clock::now();
    if (child_.fed() != fed_ || (!none && size != size_)) last_ = now;
    fed_ = child_.fed();
    if (!none) size_ = size;
    if (now - last_ <= patience_.still) return {};
    return Error{fmt::format("ffmpeg made no progress for {} s and was ended",
                             static_cast<double>(patience_.still.count()) / 1000)};
  }

 private:
  const ChildProcess& child_;
  const std::string path_;
  const VideoPatience& patience_;
  size_t fed_ = 0;
  uintmax_t size_ = 0;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

Status encode(const std::string& ffmpeg, const VideoDesc& video, const VideoFrames& frames,
              const VideoPatience& patience, const std::string& path) {
  const std::vector<std::string> pictures = video_pictures(video, frames);
  const auto first = read_picture(pictures.front());
  if (!first) return first.error();
  std::vector<std::string> words = patience.starter;
  words.push_back(ffmpeg);
  for (std::string& word : ffmpeg_arguments(video, frames, *first, fs::absolute(path))) {
    words.push_back(std::move(word));
  }
  auto child = ChildProcess::start(words.front(), {words.begin() + 1, words.end()}, "ffmpeg");
  if (!child) return child.error();
  Progress progress(*child, path, patience);
  const auto may_go_on = [&] { return progress.check(); };
  for (const std::string& picture : pictures) {
    const auto raw = read_picture(picture);
    if (!raw) return raw.error();
    if (auto alike = check_alike(*first, *raw, picture); !alike) return alike;
    const auto fed = child->feed(raw->data, may_go_on);
    if (!fed) return fed.error();
    if (!*fed) break;
  }
  return child->finish(may_go_on);
}

}  // namespace

bool have_ffmpeg() { return find_program("ffmpeg").has_value(); }

std::vector<std::string> missing_pictures(const VideoDesc& video, const VideoFrames& frames) {
  std::vector<std::string> paths = video_pictures(video, frames);
  std::erase_if(paths, [](const std::string& path) { return fs::exists(path); });
  return paths;
}

Status make_video(const VideoDesc& video, const VideoFrames& frames,
                  const VideoPatience& patience) {
  const std::string path = (fs::path(frames.folder) / video_file(video, frames)).string();
  const std::string context = "cannot make " + path;
  if (frames.numbers.empty()) return Error{context + ": it has no frames"};
  if (const auto missing = missing_pictures(video, frames); !missing.empty()) {
    return Error{fmt::format("{}: of its {} frames {} {} not there ({}{})", context,
                             frames.numbers.size(), missing.size(),
                             missing.size() == 1 ? "is" : "are", missing.front(),
                             missing.size() == 1 ? "" : ", ...")};
  }
  const auto ffmpeg = find_program("ffmpeg");
  if (!ffmpeg) return Error{context + ": " + kNoFfmpeg};
  const Status made = replace_file(path, [&](const std::string& temporary) {
    return encode(*ffmpeg, video, frames, patience, temporary);
  });
  return made || made.error().message.starts_with("cannot write") ? made : made.error().in(context);
}

void remove_video_pictures(const VideoDesc& video, const VideoFrames& frames) {
  std::error_code ignored;
  for (const std::string& path : video_pictures(video, frames)) fs::remove(path, ignored);
  fs::remove(fs::path(frames.folder) / video_folder(video), ignored);
}

}  // namespace hyades::core
