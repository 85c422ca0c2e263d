#include "experiments/store/sqlite.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <limits>

#include "sim/check.h"

namespace framesim {
namespace {

std::string reason(int code, const char* message) {
  switch (code & 0xff) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "is locked by another program; wait for it or end it, then run the same command again";
    case SQLITE_NOTADB:
      return "is not an SQLite database; name another file";
    case SQLITE_FULL:
      return "cannot be written: the disk is full";
    case SQLITE_IOERR:
      return fmt::format("cannot be written, or not read back: {}; is the disk full?", message);
    case SQLITE_CORRUPT:
      return fmt::format("is damaged: {}", message);
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
      return fmt::format("cannot be opened or written: {}; are its file and folder writable?", message);
    default:
      return message;
  }
}

[[noreturn]] void fail_with(const std::string& path, int code, sqlite3* database) {
  throw InputError({path}, reason(code, database ? sqlite3_errmsg(database) : sqlite3_errstr(code)));
}

// SQLite takes a file of fewer bytes than its header for an empty database, and would write over what is in it.
bool is_foreign(const std::string& path) {
  constexpr std::string_view kHeader("SQLite format 3\0", 16);
  std::ifstream in(path, std::ios::binary);
  std::array<char, 16> head{};
  in.read(head.data(), head.size());
  return !kHeader.starts_with(std::string_view(head.data(), static_cast<std::size_t>(in.gcount())));
}

}  // namespace

void Statement::Close::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
void Database::Close::operator()(sqlite3* database) const { sqlite3_close(database); }

Statement::Statement(sqlite3* database, std::string_view path, std::string_view sql)
    : database_(database), path_(path) {
  sqlite3_stmt* made = nullptr;
  const char* rest = nullptr;
  const int code = sqlite3_prepare_v2(database, sql.data(), static_cast<int>(sql.size()), &made, &rest);
  statement_.reset(made);
  if (code != SQLITE_OK) fail(code);
  if (!made) throw InputError({path_}, "an empty SQL statement");
  const std::string_view behind(rest, static_cast<std::size_t>(sql.data() + sql.size() - rest));
  if (behind.find_first_not_of(" \t\r\n;") != std::string_view::npos) {
    throw InputError({path_}, "more than one SQL statement; allowed: one");
  }
}

void Statement::fail(int code) const { fail_with(path_, code, database_); }

void Statement::bind(int at, std::int64_t value) {
  if (const int code = sqlite3_bind_int64(statement_.get(), at, value)) fail(code);
}
void Statement::bind(int at, double value) {
  if (const int code = sqlite3_bind_double(statement_.get(), at, value)) fail(code);
}
void Statement::bind(int at, std::string_view text) {
  const int code =
      sqlite3_bind_text(statement_.get(), at, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
  if (code) fail(code);
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) {
    const std::string why = reason(code, sqlite3_errmsg(database_));
    sqlite3_reset(statement_.get());
    throw InputError({path_}, why);
  }
  sqlite3_reset(statement_.get());
  return false;
}

void Statement::run() {
  while (step()) {
  }
}

std::int64_t Statement::whole(int column) const { return sqlite3_column_int64(statement_.get(), column); }
double Statement::number(int column) const {
  return is_null(column) ? std::numeric_limits<double>::quiet_NaN() : sqlite3_column_double(statement_.get(), column);
}
std::string Statement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  return text ? std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))) : "";
}
bool Statement::is_null(int column) const { return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL; }
bool Statement::is_text(int column) const {
  const int type = sqlite3_column_type(statement_.get(), column);
  return type == SQLITE_TEXT || type == SQLITE_BLOB;
}
bool Statement::is_whole(int column) const { return sqlite3_column_type(statement_.get(), column) == SQLITE_INTEGER; }
int Statement::columns() const { return sqlite3_column_count(statement_.get()); }
std::string Statement::name(int column) const { return sqlite3_column_name(statement_.get(), column); }
bool Statement::only_reads() const { return sqlite3_stmt_readonly(statement_.get()) != 0; }

void Database::open(const std::string& name, int flags) {
  sqlite3* made = nullptr;
  const int code = sqlite3_open_v2(name.c_str(), &made, flags, nullptr);
  database_.reset(made);
  if (code != SQLITE_OK) fail_with(path_, code, made);
  wait_for_locks(kOpeningWait_ms);
}

Database::Database(const std::string& path, Open how) : path_(path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw InputError({path}, "is a folder, not a store");
  if (how != Open::create && !std::filesystem::exists(path, ignored)) throw InputError({path}, "there is no such file");
  if (is_foreign(path)) throw InputError({path}, reason(SQLITE_NOTADB, ""));
  // Reading too, as only who may write takes SQLite's helper files away again at the end. A file that may not be
  // written is opened for reading by itself.
  open(path, SQLITE_OPEN_READWRITE | (how == Open::create ? SQLITE_OPEN_CREATE : 0));
  try {
    if (how == Open::read_only) run("PRAGMA query_only = ON");
    whole("SELECT count(*) FROM sqlite_master");  // opening alone reads nothing
  } catch (const InputError&) {
    // A store in a folder that cannot be written: SQLite would make its lock file there. Nobody else can either.
    if (how != Open::read_only || std::filesystem::exists(path + "-wal", ignored)) throw;
    std::string escaped;
    for (const char c : std::filesystem::absolute(path).string()) {
      escaped += c == '%' || c == '?' || c == '#' ? fmt::format("%{:02x}", static_cast<int>(c)) : std::string(1, c);
    }
    open("file:" + escaped + "?immutable=1", SQLITE_OPEN_READONLY | SQLITE_OPEN_URI);
    whole("SELECT count(*) FROM sqlite_master");
  }
}

void Database::wait_for_locks(int milliseconds) { sqlite3_busy_timeout(database_.get(), milliseconds); }

void Database::run(std::string_view sql) {
  const int code = sqlite3_exec(database_.get(), std::string(sql).c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail_with(path_, code, database_.get());
}

std::int64_t Database::whole(std::string_view sql) const {
  Statement statement = prepare(sql);
  return statement.step() ? statement.whole(0) : 0;
}

Transaction::~Transaction() {
  if (!open_) return;
  try {
    database_.run("ROLLBACK");
  } catch (const InputError&) {  // SQLite has rolled back by itself, or does when the file is opened next
  }
}

void Transaction::commit() {
  database_.run("COMMIT");
  open_ = false;
}

}  // namespace framesim
