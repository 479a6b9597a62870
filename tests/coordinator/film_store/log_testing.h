#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "coordinator/film_store/film_log.h"
#include "tests/coordinator/film_store/faulty_files.h"

namespace hyades::coordinator {

inline const char* const kFolder = "log";

inline std::vector<std::byte> record_of(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

inline std::string text_of(std::span<const std::byte> record) {
  return {reinterpret_cast<const char*>(record.data()), record.size()};
}

inline FilmLogOptions options_with(FaultyFiles& files) {
  FilmLogOptions options;
  options.files = &files;
  options.commit_delay = std::chrono::microseconds(0);
  return options;
}

/// Nothing is written before sync() asks for it, so that a fault meets the write that a test means.
inline FilmLogOptions options_writing_at_sync(FaultyFiles& files) {
  FilmLogOptions options = options_with(files);
  options.commit_delay = std::chrono::hours(1);
  return options;
}

/// An open log and what its replay gave.
struct Opened {
  std::unique_ptr<FilmLog> log;
  std::vector<std::string> records;
  ReplayReport report;
};

inline Opened open_log(const FilmLogOptions& options, const std::string& folder = kFolder,
                       const std::string& key = "key") {
  Opened opened;
  auto log = FilmLog::open(folder, key, options);
  if (!log) {
    ADD_FAILURE() << log.error().message;
    return opened;
  }
  auto report = (*log)->replay([&](std::span<const std::byte> record) {
    opened.records.push_back(text_of(record));
    return core::Status();
  });
  if (!report) {
    ADD_FAILURE() << report.error().message;
    return opened;
  }
  opened.log = std::move(*log);
  opened.report = *report;
  return opened;
}

inline Opened open_log(FaultyFiles& files) { return open_log(options_with(files)); }

}  // namespace hyades::coordinator
