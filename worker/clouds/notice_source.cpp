#include "worker/clouds/notice_source.h"

#include <ctime>
#include <string>

#include <fmt/format.h>

namespace hyades::worker {
namespace {

using Looked = core::Result<std::optional<Notice>>;

constexpr long kOk = 200;
constexpr long kUnauthorized = 401;
constexpr long kNotFound = 404;

core::Error wrong_status(const std::string& path, long status) {
  return {fmt::format("{} answers {}", path.substr(0, path.find('?')), status)};
}

/// Two minutes of notice. A token is asked for first (IMDSv2), and 404 means that all is well.
class Aws : public NoticeSource {
 public:
  explicit Aws(const Metadata& metadata) : metadata_(metadata) {}
  std::chrono::milliseconds pause() const override { return std::chrono::seconds(5); }

  Looked look() override {
    if (token_.empty()) {
      const std::string path = "/latest/api/token";
      const auto token = metadata_.ask(path, {"X-aws-ec2-metadata-token-ttl-seconds: 21600"},
                                       std::chrono::seconds(10), true);
      if (!token) return token.error();
      if (token->status != kOk) return wrong_status(path, token->status);
      if (token->body.empty() || token->body.size() > 1000 ||
          token->body.find_first_of("\r\n") != std::string::npos) {
        return core::Error{path + ": what came is no token"};
      }
      token_ = token->body;
    }
    const std::string path = "/latest/meta-data/spot/instance-action";
    const auto action = metadata_.ask(path, {"X-aws-ec2-metadata-token: " + token_});
    if (!action) return action.error();
    if (action->status == kNotFound) return std::optional<Notice>();
    if (action->status == kUnauthorized) token_.clear();  // it has expired
    if (action->status != kOk) return wrong_status(path, action->status);
    auto notice = parse_aws(action->body, std::time(nullptr));
    if (!notice) return notice.error().in(path);
    return std::optional(*notice);
  }

 private:
  const Metadata& metadata_;
  std::string token_;
};

/// Thirty seconds of notice. The service answers when the value changes, at the latest after
/// kWait; beside it stands what maintenance will do to a machine that cannot move.
class Gcp : public NoticeSource {
 public:
  explicit Gcp(const Metadata& metadata) : metadata_(metadata) {}
  std::chrono::milliseconds pause() const override { return std::chrono::seconds(1); }

  Looked look() override {
    const std::string base = "/computeMetadata/v1/instance/";
    std::string path = base + "preempted";
    if (!etag_.empty()) {
      path += fmt::format("?wait_for_change=true&timeout_sec={}&last_etag={}", kWait, etag_);
    }
    const auto preempted = ask(path);
    if (!preempted) return preempted.error();
    const auto yes = parse_gcp_preempted(preempted->body);
    if (!yes) return yes.error().in(base + "preempted");
    if (*yes) return said();
    etag_ = preempted->etag;
    const auto maintenance = ask(base + "maintenance-event");
    if (!maintenance) return maintenance.error();
    if (maintenance->body.starts_with("TERMINATE_ON_HOST_MAINTENANCE")) return said();
    return std::optional<Notice>();
  }

 private:
  static constexpr int kWait = 20;

  static Looked said() {
    const std::time_t now = std::time(nullptr);
    return std::optional(notice_at(now + static_cast<std::time_t>(kShortestNotice), now));
  }

  core::Result<Metadata::Answer> ask(const std::string& path) {
    auto answer =
        metadata_.ask(path, {"Metadata-Flavor: Google"}, std::chrono::seconds(kWait + 10));
    if (answer && answer->status == kOk) return answer;
    etag_.clear();  // so that the next look does not wait for a change that was missed
    if (!answer) return answer;
    return wrong_status(path, answer->status);
  }

  const Metadata& metadata_;
  std::string etag_;
};

/// At least thirty seconds of notice. Events are those of all machines of a group: ours are the
/// ones that name this machine.
class Azure : public NoticeSource {
 public:
  explicit Azure(const Metadata& metadata) : metadata_(metadata) {}
  std::chrono::milliseconds pause() const override { return std::chrono::seconds(2); }

  Looked look() override {
    if (machine_.empty()) {
      const std::string path = "/metadata/instance/compute/name?api-version=2021-02-01&format=text";
      const auto name = metadata_.ask(path, {"Metadata: true"});
      if (!name) return name.error();
      if (name->status != kOk) return wrong_status(path, name->status);
      if (name->body.empty()) return core::Error{"the machine has no name"};
      machine_ = name->body;
    }
    const std::string path = "/metadata/scheduledevents?api-version=2020-07-01";
    const auto events = metadata_.ask(path, {"Metadata: true"});
    if (!events) return events.error();
    if (events->status != kOk) return wrong_status(path, events->status);
    auto notice = parse_azure(events->body, machine_, std::time(nullptr));
    if (!notice) return notice.error().in("/metadata/scheduledevents");
    return notice;
  }

 private:
  const Metadata& metadata_;
  std::string machine_;
};

}  // namespace

std::unique_ptr<NoticeSource> make_notice_source(Cloud cloud, const Metadata& metadata) {
  switch (cloud) {
    case Cloud::aws:
      return std::make_unique<Aws>(metadata);
    case Cloud::gcp:
      return std::make_unique<Gcp>(metadata);
    case Cloud::azure:
      return std::make_unique<Azure>(metadata);
  }
  return nullptr;
}

}  // namespace hyades::worker
