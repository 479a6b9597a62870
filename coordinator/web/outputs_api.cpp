#include "coordinator/web/outputs_api.h"

#include <algorithm>
#include <utility>

#include "coordinator/controller/not_there.h"
#include "coordinator/web/byte_range.h"
#include "coordinator/web/file_source.h"
#include "coordinator/web/route_helpers.h"
#include "coordinator/web/zip_source.h"
#include "core/base/assets.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr uint32_t kRowsAtOnce = 1000;
/// Of an answer: some two megabytes.
constexpr uint32_t kMostListed = 10'000;

const char* media_type_of(const std::string& path) {
  constexpr std::pair<const char*, const char*> kTypes[] = {
      {".png", "image/png"},  {".jpg", "image/jpeg"},      {".jpeg", "image/jpeg"},
      {".tif", "image/tiff"}, {".tiff", "image/tiff"},     {".exr", "image/x-exr"},
      {".mp4", "video/mp4"},  {".mov", "video/quicktime"}, {".webm", "video/webm"}};
  for (const auto& [ending, type] : kTypes) {
    if (path.ends_with(ending)) return type;
  }
  return "application/octet-stream";
}

/// A file's name as a header holds it: nothing but harmless characters.
std::string header_name(const std::string& path) {
  std::string name = path.substr(path.rfind('/') + 1);
  for (char& c : name) {
    const bool harmless = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '_';
    if (!harmless) c = '_';
  }
  return name;
}

WebReply not_found(uint64_t job, const std::string& path) {
  return error_reply(
      {grpc::StatusCode::NOT_FOUND, fmt::format("job {} has no output '{}' (yet)", job, path)});
}

WebReply lost(const std::string& path) {
  return error_reply({grpc::StatusCode::DATA_LOSS, path + " is damaged on the coordinator's disk"});
}

}  // namespace

core::Result<OutputsPage> finished_files(Controller& controller, uint64_t job, uint64_t after,
                                         size_t limit) {
  OutputsPage page;
  page.after = after;
  while (page.outputs.size() < limit) {
    auto outputs = controller.store().outputs(
        job, page.after,
        static_cast<uint32_t>(std::min<size_t>(kRowsAtOnce, limit - page.outputs.size())));
    if (!outputs) return outputs.error();
    page.more = !outputs->empty();
    if (!page.more) break;
    page.after = outputs->back().number;
    for (StoredOutput& output : *outputs) {
      if (!controller.queries().is_for_video(job, output.path))
        page.outputs.push_back(std::move(output));
    }
  }
  return page;
}

void OutputsApi::add_routes(Router& router) {
  const std::string base = "/api/v1/jobs/{job}/";
  add_by_hand<v1::OutputsPageRequest>(
      router, executors_.store, "GET", base + "outputs",
      [this](const v1::OutputsPageRequest& asked, const WebRequest&) { return list(asked); });
  add_by_hand<v1::OutputRequest>(router, executors_.files, "GET", base + "outputs/{path...}",
                                 [this](const v1::OutputRequest& asked, const WebRequest& request) {
                                   return file(asked, request);
                                 });
  add_by_hand<v1::JobRequest>(
      router, executors_.files, "GET", base + "archive.zip",
      [this](const v1::JobRequest& asked, const WebRequest&) { return archive(asked.job()); });
}

WebReply OutputsApi::list(const v1::OutputsPageRequest& asked) {
  const uint64_t job = asked.job();
  const auto state = controller_.store().state(job);
  if (!state) return error_reply(farm::unavailable(state.error()));
  if (!*state) return error_reply(no_job(job));
  OutputsPage page;
  if (asked.has_frame()) {
    auto outputs = controller_.store().outputs_of(job, asked.frame());
    if (!outputs) return error_reply(farm::unavailable(outputs.error()));
    page.outputs = std::move(*outputs);
    std::erase_if(page.outputs, [&](const StoredOutput& output) {
      return controller_.queries().is_for_video(job, output.path);
    });
  } else {
    auto found = finished_files(controller_, job, asked.after(),
                                asked.limit() == 0 ? kMostListed : asked.limit());
    if (!found) return error_reply(farm::unavailable(found.error()));
    page = std::move(*found);
  }
  farm::Json all = farm::Json::array();
  for (const StoredOutput& output : page.outputs) {
    all.push_back({{"id", output.path},
                   {"frame", output.frame},
                   {"size", output.size},
                   {"sha256", farm::hex_from_wire(output.sha256)}});
  }
  return json_reply({{"outputs", std::move(all)}, {"after", page.after}, {"more", page.more}});
}

WebReply OutputsApi::file(const v1::OutputRequest& asked, const WebRequest& request) {
  const uint64_t job = asked.job();
  const std::string& path = asked.path();
  // The path is looked up among the job's outputs and never taken for one of the file system's.
  const auto output = controller_.store().output(job, path);
  if (!output) return error_reply(farm::unavailable(output.error()));
  if (!*output) return not_found(job, path);
  auto bytes = core::map_file(controller_.output_folder(job) + "/" + (*output)->path);
  if (!bytes || bytes->size() != (*output)->size) return lost(path);
  const uint64_t size = bytes->size();
  WebReply reply;
  reply.type = media_type_of(path);
  reply.headers = {{"Accept-Ranges", "bytes"},
                   {"ETag", "\"" + farm::hex_from_wire((*output)->sha256) + "\""},
                   {"Cache-Control", "private, no-cache"},
                   {"Content-Security-Policy", "sandbox"}};
  reply.headers.emplace_back(
      "Content-Disposition",
      fmt::format("{}; filename=\"{}\"", asked.download() ? "attachment" : "inline",
                  header_name(path)));
  // The rest of another file would not fit to what the client has.
  const std::string& tag = request.header("if-range");
  const bool same = tag.empty() || tag == reply.headers[1].second;
  const std::string range = same ? request.header("range") : "";
  ByteRange part{0, size == 0 ? 0 : size - 1};
  const RangeAsked wanted = read_range(range, size, part);
  if (wanted == RangeAsked::impossible) {
    WebReply none =
        error_reply({grpc::StatusCode::OUT_OF_RANGE, fmt::format("the file has {} bytes", size)});
    none.headers.emplace_back("Content-Range", fmt::format("bytes */{}", size));
    return none;
  }
  if (wanted == RangeAsked::part) {
    reply.status = 206;
    reply.headers.emplace_back("Content-Range",
                               fmt::format("bytes {}-{}/{}", part.first, part.last, size));
  }
  const uint64_t count = size == 0 ? 0 : part.last - part.first + 1;
  reply.source = std::make_shared<FileSource>(std::move(*bytes), part.first, count);
  return reply;
}

WebReply OutputsApi::archive(uint64_t job) {
  const auto stored = controller_.store().job(job);
  if (!stored) return error_reply(farm::unavailable(stored.error()));
  if (!*stored) return error_reply(no_job(job));
  const auto page = finished_files(controller_, job, 0, SIZE_MAX);
  if (!page) return error_reply(farm::unavailable(page.error()));
  std::vector<ZipSource::File> files;
  for (const StoredOutput& output : page->outputs) {
    files.push_back({output.path, controller_.output_folder(job) + "/" + output.path, output.size});
  }
  WebReply reply;
  reply.type = "application/zip";
  reply.headers = {{"Cache-Control", "no-store"},
                   {"Content-Disposition", fmt::format("attachment; filename=\"{}-{}.zip\"",
                                                       header_name((*stored)->name), job)}};
  reply.source = std::make_shared<ZipSource>(std::move(files));
  return reply;
}

}  // namespace hyades::coordinator
