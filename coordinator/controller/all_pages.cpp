#include "coordinator/controller/all_pages.h"

#include <utility>

#include "coordinator/controller/controller.h"

namespace hyades::coordinator {

std::vector<v1::Job> all_open_jobs(Controller& controller) {
  std::vector<v1::Job> all;
  v1::ListJobsRequest request;
  do {
    v1::ListJobsResponse response;
    if (!controller.queries().list_open(request, response))
      break;  // it says no only to who asks for ended ones, too
    for (v1::Job& job : *response.mutable_jobs()) all.push_back(std::move(job));
    request.set_before(response.next_before());
  } while (request.before() != 0);
  return all;
}

std::vector<v1::Worker> all_workers(Controller& controller) {
  std::vector<v1::Worker> all;
  v1::WorkersRequest request;
  do {
    v1::WorkersResponse response;
    controller.farm().workers(request, response);
    for (v1::Worker& worker : *response.mutable_workers()) all.push_back(std::move(worker));
    request.set_after(response.next_after());
  } while (request.after() != 0);
  return all;
}

}  // namespace hyades::coordinator
