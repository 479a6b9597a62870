#pragma once

#include <string_view>
#include <vector>

namespace hyades::coordinator {

/// A file of the dashboard, which the program carries within itself.
struct DashboardFile {
  const char* name;  ///< "index.html", "openapi.yaml", "style.css", ...
  std::string_view bytes;
};

/// All of them (made by embed_files.cmake from dashboard/ and api/).
std::vector<DashboardFile> dashboard_files();

}  // namespace hyades::coordinator
