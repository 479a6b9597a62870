#include "import/job_files.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <ios>
#include <iosfwd>
#include <streambuf>
#include <utility>

#include "core/job/scene_document.h"
#include "core/job/yaml_writer.h"
#include "import/scene_job.h"
#include "import/stand_in.h"

namespace hyades::core {

namespace {

/// A stream over bytes that it shares.
class BytesStream : private std::streambuf, public std::istream {
 public:
  explicit BytesStream(Bytes bytes) : std::istream(this), bytes_(std::move(bytes)) {
    char* const begin = const_cast<char*>(bytes_.chars());  // read only
    setg(begin, begin, begin + bytes_.size());
  }

 private:
  std::streampos seekoff(std::streamoff by, std::ios_base::seekdir from,
                         std::ios_base::openmode) override {
    const std::streamoff size = egptr() - eback();
    const std::streamoff start = from == std::ios_base::beg   ? 0
                                 : from == std::ios_base::cur ? gptr() - eback()
                                                              : size;
    const std::streamoff to = start + by;
    if (to < 0 || to > size) return std::streampos(std::streamoff(-1));
    setg(eback(), eback() + to, egptr());
    return std::streampos(to);
  }
  std::streampos seekpos(std::streampos to, std::ios_base::openmode mode) override {
    return seekoff(std::streamoff(to), std::ios_base::beg, mode);
  }

  Bytes bytes_;
};

/// Whether the file is a job or scene by its name, and the options are for what it is.
Status check_options(const std::string& path, const JobFileOptions& options) {
  if (const std::string hint = hint_for_scene_file(path); !hint.empty() || names_picture(path)) {
    return Error{path + ": expected a job (.yaml), or a scene, mesh or script (.blend, " +
                 scene_file_ends() + ")" + hint};
  }
  const bool tells_all = is_script_file(path) || !is_scene_file(path);
  if (!options.media.empty() && tells_all) {
    return Error{path +
                 ": --media is for scenes and meshes (.glb, .obj, ...); a job names its "
                 "media itself"};
  }
  if (!options.set.empty() && !is_script_file(path)) {
    return Error{path +
                 ": --set is for scripts (.lua); a job sets those of the scripts that it includes: "
                 "include: {lua: city.lua, set: {" +
                 options.set.front().first + ": ...}}"};
  }
  return {};
}

}  // namespace

std::string reference_from(const std::string& path, const std::string& folder) {
  if (path.empty()) return path;
  const auto normal = [](const std::filesystem::path& p) {
    return std::filesystem::absolute(p).lexically_normal();
  };
  const std::filesystem::path from = normal(folder.empty() ? "." : folder + "/");
  return normal(path).lexically_relative(from).string();
}

std::string folder_of(const std::string& path) {
  const std::filesystem::path file(path);
  return file.has_parent_path() ? file.parent_path().string() : ".";
}

Result<std::unique_ptr<JobFiles>> JobFiles::open(const std::string& path,
                                                 const JobFileOptions& options) {
  std::unique_ptr<JobFiles> opened(new JobFiles);
  opened->folder_ = folder_of(path);
  opened->disk_ = make_file_resolver(opened->folder_);
  opened->importing_ = std::make_unique<ImportingResolver>(
      *opened->disk_, options.missing,
      options.follow_links ? SceneLinks() : SceneLinks(opened->folder_));
  const std::string file = std::filesystem::path(path).filename().string();
  if (auto fit = check_options(path, options); !fit) return fit.error();
  if (!is_scene_file(path)) {
    opened->document_ = file;
    return opened;
  }
  SceneJobRequest request;
  request.scene = file;
  request.media = reference_from(options.media, opened->folder_);
  request.media_in_job = request.media;
  request.how.animation = options.animation;
  request.how.loop = options.loop;
  request.how.set = options.set;
  if (is_script_file(path)) request.how.fps = 0.0F;
  request.how.made = file + std::string(kMadeFolder) + "/";
  auto job = scene_job(opened->importing_->sources(), request);
  if (!job) return job.error();
  const auto inside = opened->importing_->check_files(file, job->files);
  if (!inside) return inside.error();
  opened->importing_->adopt(file, job->source);
  opened->notes_ = std::move(job->notes);
  opened->document_ = file + ".yaml";
  opened->importing_->add(opened->document_, is_script_file(path)
                                                 ? write_yaml_of_script(*job->tree, file)
                                                 : write_yaml(*job->tree));
  return opened;
}

std::vector<std::string> JobFiles::notes() const {
  std::vector<std::string> all = notes_;
  for (std::string& line : importing_->notes()) {
    if (std::find(all.begin(), all.end(), line) == all.end()) all.push_back(std::move(line));
  }
  return all;
}

std::unique_ptr<std::istream> JobFiles::stream(const std::string& reference) {
  if (importing_->is_on_disk(reference)) {
    const auto path = std::filesystem::path(folder_) / reference;
    return std::make_unique<std::ifstream>(path, std::ios::binary);
  }
  auto bytes = importing_->open(reference);
  if (!bytes) {
    auto none = std::make_unique<std::ifstream>();
    none->setstate(std::ios::failbit);
    return none;
  }
  return std::make_unique<BytesStream>(std::move(*bytes));
}

}  // namespace hyades::core
