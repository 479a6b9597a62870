#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>

#include "tests/support/temp_folder.h"

namespace hyades::test {

/// Whether PostgreSQL's server is installed. Where it is not, the test that asks is skipped, or has
/// failed if the environment variable CI is "true". In SetUp(): if (!postgres_is_there()) return;
bool postgres_is_there();

/// A PostgreSQL server in a temporary folder, on a port of 127.0.0.1 and a socket in the folder. It
/// ends with its object, or with the process. Its texts sort as English ones do, not by their
/// bytes. Throws where it does not start.
class PostgresServer {
 public:
  /// `durable`: what is committed outlives kill(). Without it, commits do not wait for the disk.
  explicit PostgresServer(bool durable = false);
  ~PostgresServer();
  PostgresServer(const PostgresServer&) = delete;
  PostgresServer& operator=(const PostgresServer&) = delete;

  /// The one that all tests of this process share, which none of them stops.
  static PostgresServer& shared();

  /// A new empty database, of which the role "farm" is the owner: its URL, with a password.
  std::string make_database();
  /// A new empty database of the role "farm": its URL by the Unix socket, which has no password.
  std::string make_database_by_socket();
  std::string password() const { return password_; }
  uint16_t port() const { return port_; }

  /// Ends the server, and with it all connections.
  void stop();
  /// Ends it as a loss of power does.
  void kill();
  /// Whoever connects from now on hears nothing; until stop().
  void freeze() const;
  /// Starts it again, on the same port.
  void start();

 private:
  std::string socket_url(const std::string& user, const std::string& database) const;
  std::string add_database();
  void end(int signal);
  bool comes_up();

  const TempFolder folder_;
  const bool durable_;
  std::string password_;
  uint16_t port_ = 0;
  pid_t pid_ = -1;
  int databases_ = 0;
};

}  // namespace hyades::test
