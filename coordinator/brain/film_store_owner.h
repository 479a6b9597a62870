#pragma once

#include <string>

#include "coordinator/brain/brain.h"

namespace hyades::coordinator {

/// Reports what becomes of one job's films to the brain.
class Brain::FilmStoreOwner final : public FilmStore::Owner {
 public:
  FilmStoreOwner(Brain& brain, JobId job) : brain_(brain), job_(job) {}

  void persisted(RecordId record) override { brain_.persisted(job_, record); }
  void not_persisted(RecordId record, const std::string& reason) override {
    brain_.not_persisted(job_, record, reason);
  }
  void try_again() override {}  // the brain's clock ticks anyway
  void storage_failed(const std::string& reason) override { brain_.storage_failed(job_, reason); }
  void drained() override {}

 private:
  Brain& brain_;
  JobId job_;
};

}  // namespace hyades::coordinator
