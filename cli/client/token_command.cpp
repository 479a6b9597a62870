// `hyades token`: who may come in. Asked of the coordinator, or, with --data, of its folder while
// it does not run: that is how the first admin comes by a token.
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/client/client_app.h"
#include "cli/client/show.h"
#include "cli/client_commands.h"
#include "coordinator/access/audit_log.h"
#include "coordinator/access/token.h"
#include "core/base/duration.h"
#include "core/base/printable.h"
#include "core/base/wall_clock.h"
#include "farm/small_file.h"
#include "farm/token_term.h"
#include "farm/wire.h"

namespace hyades::cli {
namespace {

constexpr const char* kLifetime = "365d";

struct TokenOptions {
  std::string data;  ///< the coordinator's folder; empty: ask the coordinator
  std::string name;
  std::string role;
  std::string expires;  ///< a time or never; empty: the command's default
  std::string output;
  std::string pool;
  uint32_t machines = 0;  ///< 0: the coordinator's default
  std::string id;
  bool of_existing = false;  ///< what is asked needs a store that is there
  bool json = false;
};

/// Where tokens are kept, whichever way they are reached.
class Tokens {
 public:
  virtual ~Tokens() = default;
  virtual Outcome create(const v1::CreateTokenRequest& request, v1::Token& token,
                         std::string& secret) = 0;
  virtual Outcome list(v1::ListTokensResponse& tokens) = 0;
  virtual Outcome revoke(const std::string& id, v1::Token& token) = 0;
};

class RemoteTokens final : public Tokens {
 public:
  explicit RemoteTokens(std::unique_ptr<FarmClient> client) : client_(std::move(client)) {}
  Outcome create(const v1::CreateTokenRequest& request, v1::Token& token,
                 std::string& secret) override {
    v1::CreateTokenResponse response;
    Outcome failed = client_->create_token(request, response);
    token = response.token();
    secret = response.secret();
    return failed;
  }
  Outcome list(v1::ListTokensResponse& tokens) override {
    uint64_t bytes = 0;
    if (Outcome failed = client_->call("Admin/ListTokens", v1::ListTokensRequest(), tokens)) {
      return failed;
    }
    return client_->count_part(tokens, bytes);
  }
  Outcome revoke(const std::string& id, v1::Token& token) override {
    v1::RevokeTokenRequest request;
    request.set_id(id);
    v1::RevokeTokenResponse response;
    Outcome failed = client_->call("Admin/RevokeToken", request, response);
    token = response.token();
    return failed;
  }

 private:
  const std::unique_ptr<FarmClient> client_;
};

/// What root has just made belongs to whom the folder belongs to: the coordinator's user.
void give_to_owner_of(const std::string& folder) {
  struct stat info {};
  if (::geteuid() != 0 || ::stat(folder.c_str(), &info) != 0 || info.st_uid == 0) return;
  for (const char* name : {"state.db", "state.db-wal", "state.db-shm", "state.db-journal",
                           "audit.jsonl", "refusals.jsonl", "uploads.jsonl"}) {
    const std::string path = folder + "/" + name;
    if (::lchown(path.c_str(), info.st_uid, info.st_gid) != 0 && errno != ENOENT) {
      std::fprintf(stderr, "%s: cannot be given to the owner of %s: %s\n", path.c_str(),
                   folder.c_str(), std::strerror(errno));
    }
  }
}

/// Who runs this command, as the system knows it.
std::string account_name() {
  const passwd* entry = ::getpwuid(::getuid());  // NOLINT(concurrency-mt-unsafe): one thread asks
  return entry != nullptr ? entry->pw_name : fmt::format("user-{}", ::getuid());
}

/// The folder of a coordinator that does not run. Its audit log tells what was done, as if the
/// coordinator had been asked.
class LocalTokens final : public Tokens {
 public:
  LocalTokens(std::string folder, std::unique_ptr<coordinator::JobStore> store,
              std::unique_ptr<coordinator::AuditLog> audit)
      : folder_(std::move(folder)), store_(std::move(store)), audit_(std::move(audit)) {}
  ~LocalTokens() override {
    audit_.reset();  // may have begun another file
    give_to_owner_of(folder_);
  }
  LocalTokens(const LocalTokens&) = delete;
  LocalTokens& operator=(const LocalTokens&) = delete;
  Outcome create(const v1::CreateTokenRequest& request, v1::Token& token,
                 std::string& secret) override {
    const auto fresh = coordinator::make_token(request, core::wall_ms());
    if (!fresh) return Failure{kBadArguments, fresh.error().message};
    const auto added = store_->add_token(fresh->row);
    note("token.create", fresh->row.id, added, request.ShortDebugString());
    if (!added) return Failure{kFailed, added.error().message};
    token = coordinator::to_wire(fresh->row);
    secret = fresh->text;
    return std::nullopt;
  }
  Outcome list(v1::ListTokensResponse& tokens) override {
    const auto rows = store_->tokens();
    if (!rows) return Failure{kFailed, rows.error().message};
    for (const auto& row : *rows) *tokens.add_tokens() = coordinator::to_wire(row);
    return std::nullopt;
  }
  Outcome revoke(const std::string& id, v1::Token& token) override {
    const auto done = store_->revoke_token(id, core::wall_ms());
    if (!done) {
      note("token.revoke", id, done, {});
      return Failure{kFailed, done.error().message};
    }
    v1::ListTokensResponse all;
    if (Outcome failed = list(all)) return failed;
    for (const v1::Token& one : all.tokens()) {
      if (one.id() == id) token = one;
    }
    if (token.id() != id) return Failure{kUnknown, fmt::format("there is no token '{}'", id)};
    note("token.revoke", id, done, {});
    return std::nullopt;
  }

 private:
  void note(const std::string& action, const std::string& id, const core::Status& done,
            const std::string& detail) {
    const auto result =
        done ? grpc::Status::OK : grpc::Status(grpc::StatusCode::UNAVAILABLE, done.error().message);
    audit_->note({coordinator::kByFolder, farm::wire_text(account_name()), v1::ROLE_ADMIN,
                  coordinator::kThisMachine},
                 action, id, result, detail);
  }
  const std::string folder_;
  const std::unique_ptr<coordinator::JobStore> store_;
  std::unique_ptr<coordinator::AuditLog> audit_;
};

std::unique_ptr<Tokens> open_tokens(const ClientApp& app, const TokenOptions& options) {
  if (options.data.empty()) {
    auto client = app.connect();
    return client ? std::make_unique<RemoteTokens>(std::move(client)) : nullptr;
  }
  const std::string file = options.data + "/state.db";
  if (!std::filesystem::is_directory(options.data)) {
    app.report({kBadArguments, options.data +
                                   ": is no folder: make it first, for the user that the "
                                   "coordinator runs as"});
    return nullptr;
  }
  if (options.of_existing && !std::filesystem::exists(file)) {
    app.report({kBadArguments,
                file + ": is not there: no coordinator has kept its data in " + options.data});
    return nullptr;
  }
  auto store = coordinator::open_sqlite_job_store(file);
  if (!store) {
    app.report({kBadArguments, store.error().message +
                                   " (--data is for a coordinator that does not run; "
                                   "without it the running one is asked)"});
    return nullptr;
  }
  auto audit = coordinator::AuditLog::open({.folder = options.data});
  give_to_owner_of(options.data);
  if (audit)
    return std::make_unique<LocalTokens>(options.data, std::move(*store), std::move(*audit));
  app.report({kFailed, audit.error().message});
  return nullptr;
}

std::string expiry_error(const std::string& text) {
  if (text == "never") return {};
  const auto seconds = core::parse_duration(text);
  if (!seconds) return seconds.error().message + ", or never";
  return *seconds >= 1 ? std::string() : text + ": expected at least a second, or never";
}

std::string moment(int64_t ms, const char* none) { return ms == 0 ? none : format_time(ms); }

std::string state_of(const v1::Token& token) {
  if (token.revoked_ms() != 0) return "revoked";
  const bool over = token.expires_ms() != 0 && token.expires_ms() <= core::wall_ms();
  return over ? "expired" : "in use";
}

/// What people have to mind of it, besides.
std::string shown_state(const v1::Token& token) {
  const std::string state = state_of(token);
  const bool soon =
      state == "in use" &&
      !farm::expiry_warning(farm::term_of(token.created_ms(), token.expires_ms()), core::wall_ms())
           .empty();
  return soon ? "expires soon" : state;
}

/// The token itself goes to standard output or into a file, what is said of it to standard error.
int hand_out(const ClientApp& app, const TokenOptions& options, const v1::Token& token,
             const std::string& secret) {
  if (!core::is_printable(secret)) {
    return app.report({kFailed, "the coordinator made a token that cannot be printed; revoke it"});
  }
  if (!options.output.empty()) {
    if (const auto written = farm::write_secret(options.output, secret + "\n"); !written) {
      return app.report({kFailed, fmt::format("{} (the token {} is made: revoke it)",
                                              written.error().message, token.id())});
    }
  }
  if (options.json) {
    Json json = to_json(token);
    if (options.output.empty()) json["secret"] = secret;
    print_json(json);
    return kDone;
  }
  if (options.output.empty()) std::printf("%s\n", secret.c_str());
  std::fprintf(
      stderr, "token %s of %s, %s, expires: %s%s\n", core::printable(token.id()).c_str(),
      core::printable(token.name()).c_str(), farm::role_name(token.role()).c_str(),
      moment(token.expires_ms(), "never").c_str(),
      options.output.empty() ? "; it is shown only now" : (", is in " + options.output).c_str());
  return kDone;
}

int create(const ClientApp& app, const TokenOptions& options, Tokens& tokens) {
  v1::CreateTokenRequest request;
  request.set_name(options.name);
  request.set_role(farm::role_of(options.role).value_or(v1::ROLE_UNSPECIFIED));
  if (options.expires != "never") {
    // What is no time is told by the option's check.
    request.set_lifetime_ms(static_cast<int64_t>(1e3 * *core::parse_duration(options.expires)));
  }
  request.set_pool(options.pool);
  request.set_machines(options.machines);
  v1::Token token;
  std::string secret;
  if (auto failure = tokens.create(request, token, secret)) return app.report(*failure);
  return hand_out(app, options, token, secret);
}

int list(const ClientApp& app, const TokenOptions& options, Tokens& tokens) {
  v1::ListTokensResponse response;
  if (auto failure = tokens.list(response)) return app.report(*failure);
  if (options.json) {
    Json all = Json::array();
    for (const v1::Token& token : response.tokens()) all.push_back(to_json(token));
    print_json(all);
    return kDone;
  }
  if (response.tokens().empty()) {
    std::printf("no tokens: make an admin's with 'hyades token create --role admin --name NAME'\n");
    return kDone;
  }
  std::vector<std::vector<std::string>> rows = {
      {"id", "role", "name", "pool", "machines", "state", "made", "expires", "last used"}};
  for (const v1::Token& token : response.tokens()) {
    const bool joins = token.role() == v1::ROLE_WORKER;
    rows.push_back({core::printable(token.id()), farm::role_name(token.role()),
                    core::printable(token.name()), core::printable(token.pool()),
                    joins ? std::to_string(token.machines()) : std::string(), shown_state(token),
                    format_time(token.created_ms()), moment(token.expires_ms(), "never"),
                    moment(token.used_ms(), "never")});
  }
  print_table(rows);
  return kDone;
}

int revoke(const ClientApp& app, const TokenOptions& options, Tokens& tokens) {
  v1::Token token;
  if (auto failure = tokens.revoke(options.id, token)) return app.report(*failure);
  if (options.json) {
    print_json(to_json(token));
  } else {
    std::printf("token %s (%s, %s) is revoked\n", core::printable(token.id()).c_str(),
                farm::role_name(token.role()).c_str(), core::printable(token.name()).c_str());
  }
  return kDone;
}

/// For how long a token was made, as --expires takes it.
std::string as_long_as(const v1::Token& token) {
  if (token.expires_ms() == 0) return "never";
  return std::to_string(std::max<int64_t>(1, (token.expires_ms() - token.created_ms()) / 1000)) +
         "s";
}

/// Another token of the same name, role and lifetime; then the old one goes.
int rotate(const ClientApp& app, TokenOptions options, Tokens& tokens) {
  v1::ListTokensResponse all;
  if (auto failure = tokens.list(all)) return app.report(*failure);
  for (const v1::Token& old : all.tokens()) {
    if (old.id() != options.id) continue;
    if (state_of(old) != "in use") {
      return app.report({kFailed, fmt::format("token {} is {}: make a new one with 'hyades token "
                                              "create'",
                                              old.id(), state_of(old))});
    }
    options.name = old.name();
    options.role = farm::role_name(old.role());
    options.pool = old.pool();
    options.machines = old.machines();
    if (options.expires.empty()) options.expires = as_long_as(old);
    if (const int status = create(app, options, tokens); status != kDone) return status;
    v1::Token gone;
    if (auto failure = tokens.revoke(options.id, gone)) return app.report(*failure);
    return kDone;
  }
  return app.report({kUnknown, fmt::format("there is no token '{}'", options.id)});
}

int whoami(const ClientApp& app, const TokenOptions& options) {
  const auto client = app.connect();
  if (!client) return kBadArguments;
  v1::WhoAmIResponse me;
  if (auto failure = client->call("Admin/WhoAmI", v1::WhoAmIRequest(), me))
    return app.report(*failure);
  if (options.json) {
    print_json({{"guarded", me.guarded()},
                {"role", farm::role_name(me.role())},
                {"name", me.name()},
                {"token_id", me.token_id()},
                {"expires_ms", me.expires_ms()}});
  } else if (!me.guarded()) {
    std::printf("the farm asks for no token: everybody may do everything\n");
  } else {
    std::printf("%s, %s (token %s, expires: %s)\n",
                me.name().empty() ? "nobody in particular" : core::printable(me.name()).c_str(),
                farm::role_name(me.role()).c_str(), core::printable(me.token_id()).c_str(),
                moment(me.expires_ms(), "never").c_str());
  }
  return kDone;
}

}  // namespace

int token_command(int argc, char** argv) {
  ClientApp client("token", "Makes, lists and revokes the tokens that open the farm.");
  CLI::App& app = client.app();
  TokenOptions options;
  app.require_subcommand(1);
  app.fallthrough();
  app.add_option("--data", options.data,
                 "folder of a coordinator that does not run: its tokens, without asking it");
  app.add_flag("--json", options.json, "print JSON");
  const auto fresh = [&](CLI::App& verb, const std::string& by_default) {
    verb.add_option("--expires", options.expires,
                    "after a time such as 12h or 30d; or never (default: " + by_default + ")")
        ->check(expiry_error);
    verb.add_option("-o,--output", options.output,
                    "file to put it in, which nobody else may read (default: it is printed)");
  };
  CLI::App* made = app.add_subcommand("create", "make a token");
  made->add_option("--role", options.role, "viewer, submitter, operator, worker or admin")
      ->check(CLI::IsMember({"viewer", "submitter", "operator", "worker", "admin"}))
      ->required();
  made->add_option("--name", options.name, "whose it is: jobs submitted with it are this owner's")
      ->required();
  made->add_option("--pool", options.pool,
                   "of workers that are in one hand: all of a pool count as one witness of what a "
                   "unit's pixels are (default: each machine is one)");
  made->add_option("--machines", options.machines,
                   "how many workers may be here by this token of a worker's (default: 1000)")
      ->check(CLI::Range(1, 20'000));
  fresh(*made, kLifetime);
  const CLI::App* listed = app.add_subcommand("list", "all tokens, and when they were last used");
  CLI::App* revoked =
      app.add_subcommand("revoke", "a token is of no use from now on, for open streams too");
  revoked->add_option("id", options.id, "its id, as list has it")->required();
  CLI::App* rotated = app.add_subcommand(
      "rotate", "make another of the same name, role and lifetime, and revoke this one");
  rotated->add_option("id", options.id, "its id, as list has it")->required();
  fresh(*rotated, "as long as the old one was made for");
  const CLI::App* me = app.add_subcommand("whoami", "what one's own token is");
  app.footer(
      "examples:\n"
      "  hyades token create --data /var/lib/hyades --role admin --name ada --output admin-token\n"
      "  hyades token create --role submitter --name alice --expires 30d --output alice-token\n"
      "  hyades token list\n"
      "  hyades token revoke 9f3a01c2\n"
      "  hyades token rotate 9f3a01c2 --output node-token\n"
      "  hyades token whoami\n"
      "docs/safety.md tells what each role may do\n"
      "exit status: 0 done, 1 it could not be done, 2 wrong arguments, 3 no coordinator answers, 4 "
      "no token, or not one that may");
  if (const auto status = client.parse(argc, argv)) return *status;
  if (me->parsed()) return whoami(client, options);
  if (made->parsed() && options.expires.empty()) options.expires = kLifetime;
  options.of_existing = !made->parsed();
  const auto tokens = open_tokens(client, options);
  if (!tokens) return kBadArguments;
  if (made->parsed()) return create(client, options, *tokens);
  if (listed->parsed()) return list(client, options, *tokens);
  return revoked->parsed() ? revoke(client, options, *tokens) : rotate(client, options, *tokens);
}

}  // namespace hyades::cli
