#pragma once

#include <string>

#include "coordinator/controller/controller.h"

namespace hyades::coordinator {

/// Reports what becomes of one job's films to the controller.
class Controller::FilmStoreOwner final : public FilmStore::Owner {
 public:
  FilmStoreOwner(Controller& controller, JobId job) : controller_(controller), job_(job) {}

  void persisted(RecordId record) override { controller_.persisted(job_, record); }
  void not_persisted(RecordId record, const std::string& reason) override {
    controller_.not_persisted(job_, record, reason);
  }
  void try_again() override {}  // the controller's clock ticks anyway
  void storage_failed(const std::string& reason) override {
    controller_.storage_failed(job_, reason);
  }
  void drained() override {}

 private:
  Controller& controller_;
  JobId job_;
};

}  // namespace hyades::coordinator
