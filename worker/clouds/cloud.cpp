#include "worker/clouds/cloud.h"

#include <fstream>

namespace hyades::worker {
namespace {

/// What every virtual machine of Azure has, and no other computer by Microsoft.
constexpr const char* kAzureAssetTag = "7783-7084-3265-9085-8269-3286-77";

std::string first_line(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

}  // namespace

const char* name_of(Cloud cloud) {
  switch (cloud) {
    case Cloud::aws:
      return "aws";
    case Cloud::gcp:
      return "gcp";
    case Cloud::azure:
      return "azure";
  }
  return "";
}

std::optional<Cloud> find_cloud(const std::string& sys) {
  const std::string dmi = sys + "/class/dmi/id/";
  if (first_line(dmi + "sys_vendor") == "Amazon EC2") return Cloud::aws;
  if (first_line(sys + "/hypervisor/uuid").starts_with("ec2")) return Cloud::aws;  // Xen
  // Laptops by Google have another product name.
  if (first_line(dmi + "product_name") == "Google Compute Engine") return Cloud::gcp;
  if (first_line(dmi + "chassis_asset_tag") == kAzureAssetTag) return Cloud::azure;
  return std::nullopt;
}

}  // namespace hyades::worker
