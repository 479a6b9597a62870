#include "coordinator/web/dashboard.h"

#include <utility>

#include "core/base/hash.h"

namespace hyades::coordinator {
namespace {

const char* type_of(std::string_view name) {
  constexpr std::pair<const char*, const char*> kTypes[] = {
      {".html", "text/html; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".mjs", "text/javascript; charset=utf-8"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".json", "application/json"},
      {".webmanifest", "application/manifest+json"},
      {".yaml", "application/yaml; charset=utf-8"}};
  for (const auto& [ending, type] : kTypes) {
    if (name.ends_with(ending)) return type;
  }
  return "application/octet-stream";
}

/// Nothing but what lies here, and nothing that is written into the page.
constexpr const char* kPolicy =
    "default-src 'self'; img-src 'self' blob: data:; media-src 'self' blob:; worker-src 'self'; "
    "style-src 'self'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'";

WebReply reply_with(const DashboardFile& file) {
  WebReply reply;
  reply.type = type_of(file.name);
  reply.text = std::make_shared<const std::string>(file.bytes);
  reply.headers = {{"Cache-Control", "no-cache"},
                   {"Content-Security-Policy", kPolicy},
                   {"Referrer-Policy", "no-referrer"},
                   {"ETag", "\"" + core::to_hex(core::sha256(file.bytes)).substr(0, 32) + "\""}};
  return reply;
}

}  // namespace

void add_dashboard(Router& router) {
  for (const DashboardFile& file : dashboard_files()) {
    const WebReply reply = reply_with(file);
    const auto handler = [reply](const WebRequest&, const Answer& answer) { answer(reply); };
    router.add("GET", std::string("/dashboard/") + file.name, handler);
    if (std::string_view(file.name) == "openapi.yaml") {
      router.add("GET", "/openapi.yaml", handler);
    }
    if (std::string_view(file.name) == "index.html") router.add("GET", "/", handler);
  }
}

}  // namespace hyades::coordinator
