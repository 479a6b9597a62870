#include "cli/display/viewer_link.h"

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstddef>
#include <ctime>
#include <memory>
#include <utility>

#include "core/base/io_reason.h"

namespace hyades::cli {
namespace {

constexpr int kLookUpMs = 100;
constexpr int kConnectLooks = 30;  // three seconds in all
constexpr int kMostReads = 16;

struct FreeAddresses {
  void operator()(addrinfo* found) const { ::freeaddrinfo(found); }
};
using Addresses = std::unique_ptr<addrinfo, FreeAddresses>;

/// What the system's resolver is asked, which looks at it until it has answered.
struct Question {
  explicit Question(const core::Address& address) : host(address.host), port(address.port) {
    wanted.ai_family = AF_UNSPEC;
    wanted.ai_socktype = SOCK_STREAM;
    request.ar_name = host.c_str();
    request.ar_service = port.c_str();
    request.ar_request = &wanted;
  }
  ~Question() {
    if (request.ar_result != nullptr) ::freeaddrinfo(request.ar_result);
  }
  Question(const Question&) = delete;
  Question& operator=(const Question&) = delete;

  std::string host;
  std::string port;
  addrinfo wanted{};
  gaicb request{};
};

/// A name server that does not answer must not hold up who gives up.
core::Result<Addresses> look_up(const core::Address& address,
                                const std::function<bool()>& give_up) {
  auto question = std::make_unique<Question>(address);
  gaicb* list[] = {&question->request};
  if (::getaddrinfo_a(GAI_NOWAIT, list, 1, nullptr) != 0) {
    return core::Error{"its name cannot be looked up now"};
  }
  const timespec wait{0, kLookUpMs * 1'000'000};
  while (::gai_error(&question->request) == EAI_INPROGRESS) {
    if (give_up()) {
      // What the resolver is at cannot be called back, and is left to it.
      if (::gai_cancel(&question->request) == EAI_NOTCANCELED)
        static_cast<void>(question.release());
      return core::Error{"its name is still looked up"};
    }
    ::gai_suspend(list, 1, &wait);
  }
  if (const int error = ::gai_error(&question->request); error != 0) {
    return core::Error{::gai_strerror(error)};
  }
  return Addresses(std::exchange(question->request.ar_result, nullptr));
}

}  // namespace

core::Status ViewerLink::open() {
  const auto found = look_up(address_, give_up_);
  if (!found) return found.error();
  std::string reason = "no address";
  for (const addrinfo* one = found->get(); one != nullptr; one = one->ai_next) {
    socket_ = core::Descriptor(
        ::socket(one->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, one->ai_protocol));
    if (!socket_.valid()) {
      reason = core::io_reason(errno);
      continue;
    }
    if (::connect(socket_.get(), one->ai_addr, one->ai_addrlen) == 0) return {};
    int failed = errno;
    if (failed == EINPROGRESS) {
      failed = ETIMEDOUT;
      for (int looks = 0; looks < kConnectLooks && !give_up_(); ++looks) {
        pollfd ready{socket_.get(), POLLOUT, 0};
        if (::poll(&ready, 1, kLookUpMs) <= 0) continue;
        socklen_t size = sizeof failed;
        ::getsockopt(socket_.get(), SOL_SOCKET, SO_ERROR, &failed, &size);
        break;
      }
      if (failed == 0) return {};
    }
    reason = core::io_reason(failed);
    socket_.close();
  }
  return core::Error{reason};
}

bool ViewerLink::is_open() {
  // A viewer says nothing; what it says all the same is of no interest.
  char ignored[4096];
  for (int reads = 0; reads < kMostReads && socket_.valid(); ++reads) {
    const ssize_t got = ::recv(socket_.get(), ignored, sizeof ignored, MSG_DONTWAIT);
    if (got > 0 || (got < 0 && errno == EINTR)) continue;
    if (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return true;
    socket_.close();
  }
  return socket_.valid();
}

bool ViewerLink::wait_until_writable() {
  while (!give_up_()) {
    pollfd ready{socket_.get(), POLLOUT, 0};
    if (::poll(&ready, 1, kLookUpMs) > 0) return true;
    if (!is_open()) return false;
  }
  return false;
}

bool ViewerLink::send(const std::string& bytes) {
  size_t done = 0;
  while (done < bytes.size() && is_open()) {
    const ssize_t sent = ::send(socket_.get(), bytes.data() + done, bytes.size() - done,
                                MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent > 0) {
      done += static_cast<size_t>(sent);
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      if (!wait_until_writable()) break;
    } else if (errno != EINTR) {
      break;
    }
  }
  if (done < bytes.size()) close();
  return done == bytes.size();
}

}  // namespace hyades::cli
