#include "cli/own_files.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <ios>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/film/film_exr.h"
#include "core/image/read_image.h"

namespace hyades::cli {
namespace {

namespace fs = std::filesystem;

/// Headers stand within the first and the last so many bytes.
constexpr std::streamoff kHeader = 1 << 18;
/// From what names the job to its name: a type, a length, a line of a film's header.
constexpr size_t kBefore = 600;

std::string part_of(std::ifstream& file, std::streamoff from, std::streamoff bytes) {
  std::string text(static_cast<size_t>(bytes), '\0');
  file.seekg(from);
  file.read(text.data(), bytes);
  return text;
}

bool is_of_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '.';
}

/// Whether `text` holds `job`, not as a part of a longer name.
bool holds_name(std::string_view text, const std::string& job) {
  for (size_t at = text.find(job); at != std::string_view::npos; at = text.find(job, at + 1)) {
    const size_t end = at + job.size();
    if (at > 0 && is_of_name(text[at - 1])) continue;
    if (end == text.size() || !is_of_name(text[end])) return true;
  }
  return false;
}

/// The texts in the header of a PNG or an EXR; none where it has none or is another file.
std::vector<std::pair<std::string, std::string>> texts_of(const std::string& path) {
  const bool png = path.ends_with(".png");
  if (!png && !path.ends_with(".exr")) return {};
  auto texts = png ? core::read_png_texts(path) : core::read_exr_texts(path);
  return texts ? std::move(*texts) : std::vector<std::pair<std::string, std::string>>{};
}

/// Where the headers of other files stand: their beginning and their end; none of what cannot be
/// read.
std::vector<std::string> headers_of(const std::string& path) {
  std::error_code none;
  std::ifstream file(path, std::ios::binary);
  const auto size = static_cast<std::streamoff>(fs::file_size(path, none));
  if (!file || none) return {};
  const std::streamoff bytes = std::min(size, kHeader);
  return {part_of(file, 0, bytes), part_of(file, size - bytes, bytes)};
}

/// What a PNG or an EXR says that it was rendered for; nothing where it is another file, or says
/// nothing.
std::optional<std::string> told_job(const std::string& path) {
  for (auto& [name, value] : texts_of(path)) {
    if (name == "hyades.job") return value;
  }
  if (!path.ends_with(".exr")) return std::nullopt;
  const auto film = core::read_film_info(path);
  return film ? std::optional(film->job_name) : std::nullopt;
}

bool names_job(std::string_view header, const std::string& job) {
  // Formats write other letters than these in ways of their own.
  const bool ascii =
      std::all_of(job.begin(), job.end(), [](char c) { return c >= ' ' && c <= '~' && c != '\\'; });
  // In the comments of JPEG and TIFF, a line each, and of videos, all in one.
  constexpr std::string_view kLine = "hyades.job: ";
  constexpr std::string_view kNext = "; hyades.";
  const size_t line = header.find(kLine);
  if (ascii && line != std::string_view::npos) {
    const std::string_view rest = header.substr(line + kLine.size());
    if (!rest.starts_with(job)) return false;
    const std::string_view after = rest.substr(job.size());
    return after.empty() || after.front() < ' ' || after.starts_with(kNext);
  }
  const bool plain = ascii && job.find(' ') == std::string::npos;
  for (const std::string_view mark : {"hyades.job", "hyades film "}) {
    const size_t at = header.find(mark);
    if (at == std::string_view::npos) continue;
    const std::string_view after = header.substr(at + mark.size(), kBefore + job.size());
    if (!plain || holds_name(after, job)) return true;
  }
  return false;
}

/// What the comment of a JPEG, a TIFF or a video says under `name`.
std::string told_in_comment(const std::string& path, const std::string& name) {
  const std::string line = name + ": ";
  for (const std::string& header : headers_of(path)) {
    const size_t at = header.find(line);
    if (at == std::string::npos) continue;
    const size_t begin = at + line.size();
    return header.substr(begin, header.find_first_not_of("0123456789", begin) - begin);
  }
  return "";
}

/// What went into the picture or film at `path`; noughts where it does not say.
PictureWork told_work(const std::string& path) {
  const bool exr = path.ends_with(".exr");
  if (exr) {
    if (const auto film = core::read_film_info(path)) return {film->samples, film->crop.area()};
  }
  std::string samples;
  std::string pixels;
  if (exr || path.ends_with(".png")) {
    for (const auto& [name, value] : texts_of(path)) {
      if (name == "hyades.samples") samples = value;
      if (name == "hyades.pixels") pixels = value;
    }
  } else {
    samples = told_in_comment(path, "hyades.samples");
    pixels = told_in_comment(path, "hyades.pixels");
  }
  PictureWork work;
  std::from_chars(samples.data(), samples.data() + samples.size(), work.samples);
  std::from_chars(pixels.data(), pixels.data() + pixels.size(), work.pixels);
  return work;
}

}  // namespace

bool is_of_job(const std::string& path, const std::string& job) {
  if (const auto told = told_job(path)) return *told == job;
  const std::vector<std::string> headers = headers_of(path);
  return std::any_of(headers.begin(), headers.end(),
                     [&](const std::string& header) { return names_job(header, job); });
}

core::Status check_own_files(const std::vector<std::string>& paths, const std::string& job) {
  std::string first;
  size_t others = 0;
  for (const std::string& path : paths) {
    std::error_code none;
    if (!fs::is_regular_file(path, none) || is_of_job(path, job)) continue;
    if (first.empty()) first = path;
    ++others;
  }
  if (first.empty()) return {};
  return core::Error{fmt::format(
      "{}{} there, and no {} of the job '{}': --overwrite replaces {}, --output DIR writes "
      "elsewhere",
      first, others > 1 ? " (and " + core::counted(others - 1, "other") + ") are" : " is",
      others > 1 ? "files" : "file", job, others > 1 ? "them" : "it")};
}

core::Status check_not_lessened(const std::vector<std::string>& paths, const PictureWork& now) {
  for (const std::string& path : paths) {
    std::error_code none;
    if (!fs::is_regular_file(path, none)) continue;
    const PictureWork there = told_work(path);
    if (there.samples <= now.samples && there.pixels <= now.pixels) continue;
    const auto words = [](const PictureWork& work) {
      return fmt::format("{} in each of {}", core::counted(work.samples, "sample"),
                         core::counted(static_cast<uint64_t>(work.pixels), "pixel"));
    };
    return core::Error{fmt::format(
        "{} has more in it than this run makes: {}, not {}. --overwrite replaces it, --output DIR "
        "writes elsewhere",
        path, words(there), words(now))};
  }
  return {};
}

}  // namespace hyades::cli
