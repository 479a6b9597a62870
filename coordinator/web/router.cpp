#include "coordinator/web/router.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "coordinator/web/request_target.h"
#include "core/base/text.h"

namespace hyades::coordinator {
namespace {

bool is_placeholder(const std::string& part) {
  return part.starts_with('{') && part.ends_with('}');
}

/// What the pattern's names stand for, where it matches.
std::optional<std::map<std::string, std::string>> match(const std::vector<std::string>& pattern,
                                                        const std::vector<std::string>& path) {
  std::map<std::string, std::string> found;
  for (size_t i = 0; i < pattern.size(); ++i) {
    if (i >= path.size()) return std::nullopt;
    const std::string& part = pattern[i];
    if (part.ends_with("...}")) {
      std::string rest = path[i];
      for (size_t k = i + 1; k < path.size(); ++k) rest += "/" + path[k];
      found[part.substr(1, part.size() - 5)] = rest;
      return found;
    }
    if (is_placeholder(part)) {
      found[part.substr(1, part.size() - 2)] = path[i];
    } else if (part != path[i]) {
      return std::nullopt;
    }
  }
  if (path.size() > pattern.size()) return std::nullopt;
  return found;
}

/// Whether a browser asks for what may be a view of the dashboard: where there is none of this name
/// the page says so, in a person's words.
bool is_view(const WebRequest& request) {
  static const std::set<std::string> kOthers = {"api", "dashboard"};
  const auto is_plain = [](const std::string& part) {
    return std::all_of(part.begin(), part.end(),
                       [](char c) { return core::is_letter_or_digit(c) || c == '-'; });
  };
  return request.method == "GET" && !request.path.empty() && !kOthers.contains(request.path[0]) &&
         request.header("accept").find("text/html") != std::string::npos &&
         std::all_of(request.path.begin(), request.path.end(), is_plain);
}

}  // namespace

void Router::add(const std::string& method, const std::string& pattern, Handler handler) {
  const Operation& operation = operation_of_route(method + " " + pattern);
  const uint64_t own = find_route(operation, method + " " + pattern).most_bytes;
  const uint64_t most_bytes = method == "GET" ? 0 : own > 0 ? own : operation.most_bytes;
  routes_.push_back(
      {method, pattern, parse_target(pattern)->path, std::move(handler), &operation, most_bytes});
}

const Router::Entry* Router::find(const WebRequest& request) const {
  for (const Entry& route : routes_) {
    if (route.method == request.method && match(route.parts, request.path)) return &route;
  }
  return nullptr;
}

void Router::answer(WebRequest request, const Answer& answer) const {
  std::string allowed;
  for (const Entry& route : routes_) {
    auto found = match(route.parts, request.path);
    if (!found) continue;
    if (route.method != request.method) {
      allowed += (allowed.empty() ? "" : ", ") + route.method;
      continue;
    }
    request.parameters = std::move(*found);
    return route.handler(request, answer);
  }
  std::string path;
  for (const std::string& part : request.path) path += "/" + part;
  if (allowed.empty() && is_view(request)) {
    // Views stand behind the '#': who types their address without it is brought there.
    WebReply there;
    there.status = 302;
    there.type.clear();
    there.headers = {{"Location", "/#" + path}, {"Cache-Control", "no-store"}};
    return answer(there);
  }
  if (allowed.empty()) {
    answer(error_reply({grpc::StatusCode::NOT_FOUND, fmt::format("there is no '{}' here", path)}));
    return;
  }
  WebReply reply = error_reply(
      {grpc::StatusCode::UNIMPLEMENTED, fmt::format("'{}' takes {} only", path, allowed)});
  reply.status = 405;
  reply.headers.emplace_back("Allow", allowed);
  answer(std::move(reply));
}

}  // namespace hyades::coordinator
