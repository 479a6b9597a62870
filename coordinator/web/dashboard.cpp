#include "coordinator/web/dashboard.h"

#include <memory>
#include <string>
#include <utility>

#include "coordinator/web/gzip.h"
#include "coordinator/web/routes.h"
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

/// A file as it is, and packed; the same where that is no shorter.
struct Forms {
  WebReply plain;
  WebReply packed;
};

Forms forms_of(const DashboardFile& file) {
  const std::string digest = core::to_hex(core::sha256(file.bytes)).substr(0, 32);
  const auto reply = [&](std::string bytes, const char* tag) {
    WebReply made;
    made.type = type_of(file.name);
    made.text = std::make_shared<const std::string>(std::move(bytes));
    made.headers = {{"Cache-Control", "no-cache"},
                    {"Content-Security-Policy", kPolicy},
                    {"Referrer-Policy", "no-referrer"},
                    {"Vary", "Accept-Encoding"},
                    {"ETag", "\"" + digest + tag + "\""}};
    return made;
  };
  Forms forms{reply(std::string(file.bytes), ""), {}};
  const std::string packed = gzip(file.bytes);
  if (packed.empty() || packed.size() >= file.bytes.size()) {
    forms.packed = forms.plain;
  } else {
    forms.packed = reply(packed, "-gzip");
    forms.packed.headers.emplace_back("Content-Encoding", "gzip");
  }
  return forms;
}

}  // namespace

void add_dashboard(Router& router) {
  for (const DashboardFile& file : dashboard_files()) {
    const auto handler = [forms = forms_of(file)](const WebRequest& request, const Answer& answer) {
      answer(takes_gzip(request.header("accept-encoding")) ? forms.packed : forms.plain);
    };
    router.add("GET", std::string("/dashboard/") + file.name, handler);
    if (std::string_view(file.name) == "openapi.yaml") {
      router.add("GET", "/openapi.yaml", handler);
    }
    if (std::string_view(file.name) == "index.html") router.add("GET", "/", handler);
  }
}

}  // namespace hyades::coordinator
