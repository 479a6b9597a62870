#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/controller/not_found.h"
#include "coordinator/operations/file_transfer.h"
#include "coordinator/web/byte_range.h"
#include "coordinator/web/route_helpers.h"
#include "coordinator/web/routes.h"
#include "coordinator/web/zip_source.h"
#include "core/base/text.h"
#include "core/job/output_path.h"
#include "farm/wire.h"
#include "farm/wire_status.h"
#include "hyades/v1/web.pb.h"

namespace hyades::coordinator {
namespace {

/// Of what an archive in the making knows of its files: more than a hundred thousand.
constexpr uint64_t kMostArchiveBytes = uint64_t{32} << 20U;
/// Of an answer: some two megabytes.
constexpr uint32_t kMostListed = 10'000;

const char* media_type_of(const std::string& path) {
  const std::string extension = core::file_extension(path);
  constexpr std::pair<const char*, const char*> kTypes[] = {
      {".png", "image/png"},  {".jpg", "image/jpeg"},      {".jpeg", "image/jpeg"},
      {".tif", "image/tiff"}, {".tiff", "image/tiff"},     {".exr", "image/x-exr"},
      {".mp4", "video/mp4"},  {".mov", "video/quicktime"}, {".webm", "video/webm"}};
  for (const auto& [known, type] : kTypes) {
    if (extension == known) return type;
  }
  return "application/octet-stream";
}

/// The name of the file at `path` as a header holds it: letters, digits, '.', '-' and '_' only.
std::string header_name(const std::string& path) {
  std::string name = path.substr(path.rfind('/') + 1);
  for (char& c : name) {
    if (!core::is_letter_or_digit(c) && c != '.' && c != '-') c = '_';
  }
  return name;
}

/// Bytes [first, first + count) of an output's file.
class FileSource final : public BodySource {
 public:
  FileSource(core::MadeFile file, uint64_t first, uint64_t count)
      : file_(std::move(file)), at_(first), end_(first + count), size_(count) {}

  std::optional<std::string> next() override {
    const uint64_t count = std::min<uint64_t>(kPieceBytes, end_ - at_);
    std::string piece(count, '\0');
    if (count > 0 && !file_.read(at_, std::as_writable_bytes(std::span(piece)))) {
      return std::nullopt;
    }
    at_ += count;
    return piece;
  }
  std::optional<uint64_t> size() const override { return size_; }

 private:
  core::MadeFile file_;
  uint64_t at_;
  uint64_t end_;
  uint64_t size_;
};

/// Finished files, in the order in which they were finished.
struct OutputsPage {
  std::vector<StoredOutput> outputs;
  uint64_t after = 0;  ///< to ask for what comes behind them
  bool more = false;   ///< something may
};

/// Finished files of a job behind `after` that are of use now: not those that wait for the video
/// which is made of them. At most `limit`.
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

WebReply list(Controller& controller, const v1::OutputsPageRequest& asked) {
  const uint64_t job = asked.job();
  const auto state = controller.store().state(job);
  if (const grpc::Status there = job_is_there(job, state); !there.ok()) {
    return error_reply(there);
  }
  OutputsPage page;
  if (asked.has_frame()) {
    auto outputs = controller.store().outputs_of(job, asked.frame());
    if (!outputs) return error_reply(farm::unavailable(outputs.error()));
    page.outputs = std::move(*outputs);
    std::erase_if(page.outputs, [&](const StoredOutput& output) {
      return controller.queries().is_for_video(job, output.path);
    });
  } else {
    auto found = finished_files(controller, job, asked.after(),
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

WebReply file(Controller& controller, const v1::OutputRequest& asked, const WebRequest& request) {
  const std::string& path = asked.path();
  StoredOutput output;
  core::MadeFile made;
  const grpc::Status opened = open_output(controller, asked.job(), path, output, made);
  if (!opened.ok()) return error_reply(opened);
  const uint64_t size = made.size();
  WebReply reply;
  reply.type = media_type_of(path);
  reply.headers = {{"Accept-Ranges", "bytes"},
                   {"ETag", "\"" + farm::hex_from_wire(output.sha256) + "\""},
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
  reply.source = std::make_shared<FileSource>(std::move(made), part.first, count);
  return reply;
}

WebReply send_archive(Controller& controller, uint64_t job) {
  const auto stored = controller.store().summary(job);
  if (const grpc::Status there = job_is_there(job, stored); !there.ok()) {
    return error_reply(there);
  }
  auto source = std::make_shared<ZipSource>(controller.output_folder(job));
  uint64_t after = 0;
  for (bool more = true; more;) {
    const auto page = finished_files(controller, job, after, kRowsAtOnce);
    if (!page) return error_reply(farm::unavailable(page.error()));
    after = page->after;
    more = page->more;
    for (const StoredOutput& output : page->outputs) source->add(output.path, output.size);
    if (source->bytes_kept() > kMostArchiveBytes) {
      return error_reply({grpc::StatusCode::FAILED_PRECONDITION,
                          "the job has more files than fit into one archive: `hyades fetch` gets "
                          "them one by one"});
    }
  }
  WebReply reply;
  reply.type = "application/zip";
  reply.headers = {{"Cache-Control", "no-store"},
                   {"Content-Disposition", fmt::format("attachment; filename=\"{}-{}.zip\"",
                                                       header_name((*stored)->name), job)}};
  reply.source = std::move(source);
  return reply;
}

}  // namespace

void add_output_routes(Router& router, Controller& controller, Executors& executors) {
  const std::string base = "/api/v1/jobs/{job}/";
  add_by_hand<v1::OutputsPageRequest>(router, executors, "GET", base + "outputs",
                                      [&](const v1::OutputsPageRequest& asked, const WebRequest&) {
                                        return list(controller, asked);
                                      });
  add_by_hand<v1::OutputRequest>(router, executors, "GET", base + "outputs/{path...}",
                                 [&](const v1::OutputRequest& asked, const WebRequest& request) {
                                   return file(controller, asked, request);
                                 });
  add_by_hand<v1::JobRequest>(router, executors, "GET", base + "archive.zip",
                              [&](const v1::JobRequest& asked, const WebRequest&) {
                                return send_archive(controller, asked.job());
                              });
}

}  // namespace hyades::coordinator
