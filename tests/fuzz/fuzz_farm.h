#pragma once

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "coordinator/access/authority.h"
#include "coordinator/controller/controller.h"
#include "core/base/hash.h"
#include "farm/log.h"
#include "farm/wire.h"
#include "tests/support/temp_folder.h"

namespace hyades::fuzz {

/// What `result` holds; ends the process where the farm cannot be made.
template <class T>
T must(core::Result<T> result) {
  if (result) return std::move(*result);
  std::fprintf(stderr, "no farm: %s\n", result.error().message.c_str());
  std::exit(1);
}

/// A coordinator in a folder of its own, without network and tokens. It has a job, and the file
/// that a submission of it names; nobody renders.
struct Farm {
  static constexpr std::string_view kDocument =
      "hyades: 1\nname: ball\nframes: {range: 1-3}\nfilm: {size: [8, 8]}\nsampling: {samples: 1}\n"
      "objects: {ball: {shape: sphere, radius: 1}}\noutputs: [{file: ball.####.exr}]\n";

  static v1::SubmitRequest submission() {
    v1::SubmitRequest request;
    v1::JobFile& file = *request.mutable_spec()->add_files();
    file.set_path("job.yaml");
    file.set_sha256(farm::to_wire(core::sha256(kDocument)));
    file.set_size(kDocument.size());
    request.mutable_spec()->set_document("job.yaml");
    request.mutable_spec()->set_name("ball");
    request.set_owner("ada");
    return request;
  }

  Farm() {
    farm::set_log("fuzz", {farm::LogLevel::error});
    coordinator::ControllerOptions options;
    options.folder = folder.file("data");
    options.finisher = "/bin/false";
    controller = must(coordinator::Controller::open(options));
    authority = must(coordinator::Authority::open(controller->store(), {}));
    const std::string name = core::to_hex(core::sha256(kDocument));
    auto writer = must(controller->assets().write(name, kDocument.size()));
    const bool written =
        writer.append(std::as_bytes(std::span(kDocument))).ok() && writer.commit().ok();
    v1::SubmitResponse made;
    if (!written || !controller->jobs().submit(submission(), false, made).ok()) {
      std::fprintf(stderr, "no farm: its job cannot be made\n");
      std::exit(1);
    }
    job = made.job().id();
  }
  ~Farm() { controller->stop(); }
  Farm(const Farm&) = delete;
  Farm& operator=(const Farm&) = delete;

  test::TempFolder folder;
  std::unique_ptr<coordinator::Controller> controller;
  std::unique_ptr<coordinator::Authority> authority;
  uint64_t job = 0;
};

}  // namespace hyades::fuzz
