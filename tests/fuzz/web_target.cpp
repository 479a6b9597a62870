// What browsers send: a request's target, its header Range and the JSON of a submission.

#include <cstdlib>

#include "coordinator/operations/operation.h"
#include "coordinator/web/byte_range.h"
#include "coordinator/web/request_form.h"
#include "coordinator/web/request_target.h"
#include "tests/fuzz/fuzz.h"

namespace hyades::fuzz {

std::vector<std::string> seeds() {
  return {"/api/v1/jobs?limit=3&state=done%20",
          "/a//b/%41?x=1&x=2&y",
          "bytes=0-99",
          "bytes=-5",
          "bytes=7-",
          R"({"name": "x", "document": "job.yaml", "files": [{"path": "job.yaml", "sha256": ")" +
              std::string(64, 'a') + R"(", "size": 12}], "priority": 5, "tags": ["gpu"],
              "frames": [{"first": 1, "last": 9, "step": 2}], "frame_order": "progressive"})"};
}

bool try_input(std::string_view input) {
  const auto target = coordinator::parse_target(input);
  if (target) {
    for (const std::string& part : target->path) {
      if (part.empty() || part == "." || part == "..") std::abort();
    }
  }
  coordinator::ByteRange range;
  const bool part = coordinator::read_range(input, 100, range) == coordinator::RangeAsked::part;
  if (part && (range.first > range.last || range.last >= 100)) {
    std::abort();
  }
  v1::SubmitRequest submission;
  const auto& route = coordinator::operation_of_route("POST /api/v1/jobs").routes.front();
  return coordinator::read_body(std::string(input), *route.body, submission).ok() || target || part;
}

}  // namespace hyades::fuzz
