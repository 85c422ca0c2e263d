// A small wrapper of SQLite's C interface: what is opened is closed, and every failure is an InputError that names the
// file (a full disk, a locked file and a foreign file are the world's doing, not framesim's).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

struct sqlite3;
struct sqlite3_stmt;

namespace framesim {

// One prepared statement. Parameters are bound by position from 1; columns are read by position from 0.
class Statement {
 public:
  Statement(sqlite3* database, std::string_view path, std::string_view sql);

  void bind(int at, std::int64_t value);
  void bind(int at, double value);  // NaN becomes NULL
  void bind(int at, std::string_view text);
  // Moves to the next row; false at the end, after which the statement may be bound and run again.
  bool step();
  // For a statement that returns no rows.
  void run();

  std::int64_t whole(int column) const;
  double number(int column) const;  // NULL: NaN
  std::string text(int column) const;
  bool is_null(int column) const;
  bool is_text(int column) const;
  bool is_whole(int column) const;
  int columns() const;
  std::string name(int column) const;
  bool only_reads() const;

 private:
  struct Close {
    void operator()(sqlite3_stmt* statement) const;
  };
  [[noreturn]] void fail(int code) const;
  sqlite3* database_;
  std::string path_;
  std::unique_ptr<sqlite3_stmt, Close> statement_;
};

class Database {
 public:
  enum class Open { create, existing, read_only };
  // How long to wait for a file that another program has locked, in milliseconds.
  static constexpr int kOpeningWait_ms = 1'000, kWorkingWait_ms = 60'000;

  // Throws InputError at `path` if it cannot be opened or is no SQLite database.
  Database(const std::string& path, Open how);

  const std::string& path() const { return path_; }
  void wait_for_locks(int milliseconds);
  void run(std::string_view sql);  // any number of statements without rows
  Statement prepare(std::string_view sql) const { return {database_.get(), path_, sql}; }
  std::int64_t whole(std::string_view sql) const;  // the first cell of the first row

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  void open(const std::string& name, int flags);
  std::string path_;
  std::unique_ptr<sqlite3, Close> database_;
};

// All or nothing: rolled back unless committed. IMMEDIATE: the write lock is taken at once, or refused at once.
class Transaction {
 public:
  explicit Transaction(Database& database) : database_(database) { database_.run("BEGIN IMMEDIATE"); }
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Database& database_;
  bool open_ = true;
};

}  // namespace framesim
