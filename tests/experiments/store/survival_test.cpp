// A store survives what happens to programs: being killed, interrupted, a full disk, other programs.
#include <fmt/format.h>
#include <signal.h>
#include <sys/resource.h>

#include <chrono>
#include <cstring>
#include <functional>
#include <thread>

#include "tests/experiments/store/store_files.h"
#include "tests/seeds.h"

namespace framesim {
namespace {
using Clock = std::chrono::steady_clock;

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// The program in a child that first does `prepare`, with stderr in a file; wait() gives its wait status.
class Child {
 public:
  Child(std::vector<std::string> arguments, const std::string& err, const std::function<void()>& prepare = {}) {
    arguments.insert(arguments.begin(), kProgramPath);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    id_ = fork();
    REQUIRE(id_ >= 0);
    if (id_ > 0) return;
    const int file = ::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    dup2(file, 2);
    if (prepare) prepare();
    execv(kProgramPath, argv.data());
    _exit(127);
  }
  void signal(int number) const { kill(id_, number); }
  int wait() const {
    int status = 0;
    REQUIRE(waitpid(id_, &status, 0) == id_);
    return status;
  }

 private:
  pid_t id_ = 0;
};

struct Undisturbed {
  std::string content;
  std::chrono::nanoseconds took{};
};

Undisturbed run_undisturbed(const TestFolder& folder) {
  const auto start = Clock::now();
  const ProgramRun run =
      run_program({"sweep", folder.path("sweep.toml"), "--store", folder.path("whole.sqlite"), "--jobs", "2"});
  const auto took = Clock::now() - start;
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  return {content_of_store(folder.path("whole.sqlite")), took};
}

std::vector<std::string> resume(const TestFolder& folder, const std::string& store) {
  return {"sweep", folder.path("sweep.toml"), "--store", folder.path(store), "--jobs", "2", "--resume"};
}

}  // namespace

TEST_CASE("sweep: killed at any point and resumed, the store is that of an undisturbed run; 50 times") {
  const TestFolder folder;
  folder.write("sweep.toml", kSmallSweep);
  const Undisturbed whole = run_undisturbed(folder);
  const auto times = static_cast<int>(seeds(50));
  int killed = 0;
  for (int i = 0; i < times; ++i) {
    // From at once to a little after it would have ended; every other time counted from when the store is there.
    const auto after = whole.took * i / times * (i % 2 == 0 ? 11 : 6) / 10;
    const std::string store = fmt::format("{}.sqlite", i);
    CAPTURE(i, after.count());
    const Child child(resume(folder, store), folder.path("err"));
    for (int ms = 0; i % 2 == 1 && ms < 1'000 && !std::filesystem::exists(folder.path(store)); ++ms) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    std::this_thread::sleep_for(after);
    child.signal(SIGKILL);
    if (WIFSIGNALED(child.wait())) ++killed;
    if (std::filesystem::exists(folder.path(store))) {
      // SQLite itself finds nothing wrong with what a kill leaves, and each run is there with all of its frames or not at all.
      const Database left(folder.path(store), Database::Open::existing);
      Statement verdict = left.prepare("PRAGMA integrity_check");
      CHECK(verdict.step());
      CHECK(verdict.text(0) == "ok");
      if (left.whole("SELECT count(*) FROM sqlite_master") > 0) {
        const std::int64_t runs = left.whole("SELECT count(*) FROM run");
        CHECK(left.whole("SELECT count(*) FROM frame") == 20 * runs);
      }
    }
    const ProgramRun resumed = run_program(resume(folder, store));
    CAPTURE(resumed.err);
    REQUIRE(resumed.exit_code == 0);
    REQUIRE(content_of_store(folder.path(store)) == whole.content);
  }
  CHECK(killed > 0);
}

TEST_CASE("sweep: SIGINT ends it in order, and --resume goes on") {
  const TestFolder folder;
  // Long enough that the signal meets it while it runs.
  std::string longer = kSmallSweep;
  longer.replace(longer.find("seeds = 3"), std::strlen("seeds = 3"), "seeds = 3000");
  folder.write("sweep.toml", longer);
  const Child child(resume(folder, "s.sqlite"), folder.path("err"));
  // Not before the first run is stored: then the handler is in place.
  const auto give_up = Clock::now() + std::chrono::seconds(30);
  const auto some_stored = [&] {
    try {
      return count_in_store(folder.path("s.sqlite"), "run") > 0;
    } catch (const std::exception&) {
      return false;
    }
  };
  while (!some_stored() && Clock::now() < give_up) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  child.signal(SIGINT);
  const int status = child.wait();
  CAPTURE(folder.read("err"));
  REQUIRE(WIFSIGNALED(status));
  CHECK(WTERMSIG(status) == SIGINT);
  CHECK(has(folder.read("err"), "of 12000 runs are in"));
  CHECK(has(folder.read("err"), "--resume goes on"));
  CHECK_FALSE(std::filesystem::exists(folder.path("s.sqlite-wal")));  // closed in order
  const std::int64_t runs = count_in_store(folder.path("s.sqlite"), "run");
  CHECK(runs > 0);
  CHECK(runs < 12'000);
  CHECK(count_in_store(folder.path("s.sqlite"), "frame") == 20 * runs);
}

TEST_CASE("sweep: a full disk is an error that loses nothing; with room, --resume ends it") {
  const TestFolder folder;
  folder.write("sweep.toml", kSmallSweep);
  const Undisturbed whole = run_undisturbed(folder);
  const rlim_t size = std::filesystem::file_size(folder.path("whole.sqlite"));
  // No file may grow beyond this: enough for the tables, not for all runs.
  const Child child(resume(folder, "s.sqlite"), folder.path("err"), [&] {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{size * 7 / 10, size * 7 / 10};
    setrlimit(RLIMIT_FSIZE, &limit);
  });
  const int status = child.wait();
  const std::string err = folder.read("err");
  CAPTURE(err);
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 3);
  CHECK(has(err, "s.sqlite: cannot be written"));
  CHECK(has(err, "of 12 runs are stored, --resume"));
  const ProgramRun resumed = run_program(resume(folder, "s.sqlite"));
  CAPTURE(resumed.err);
  REQUIRE(resumed.exit_code == 0);
  CHECK(content_of_store(folder.path("s.sqlite")) == whole.content);
}

TEST_CASE("sweep: locked, foreign and impossible files are refused and left as they are") {
  const TestFolder folder;
  folder.write("sweep.toml", kSmallSweep);
  const auto refused = [&](const std::string& store, int exit_code, const std::string& words) {
    const ProgramRun run = run_program(resume(folder, store));
    CAPTURE(run.err, words);
    CHECK(run.exit_code == exit_code);
    CHECK(has(run.err, words));
  };
  folder.write("text.sqlite", std::string(4096, 'x'));
  refused("text.sqlite", 3, "is not an SQLite database");
  CHECK(folder.read("text.sqlite") == std::string(4096, 'x'));
  folder.write("short.txt", "my notes");  // which SQLite would take for an empty database
  refused("short.txt", 3, "is not an SQLite database");
  CHECK(folder.read("short.txt") == "my notes");
  Database(folder.path("foreign.sqlite"), Database::Open::create).run("CREATE TABLE song (title TEXT)");
  const std::string foreign = folder.read("foreign.sqlite");
  refused("foreign.sqlite", 3, "another program");
  CHECK(folder.read("foreign.sqlite") == foreign);
  std::filesystem::create_directory(folder.path("folder"));
  refused("folder", 2, "it is a folder");
  refused("none/s.sqlite", 2, "there is no folder");
  refused("sweep.toml/s.sqlite", 2, "there is no folder");
  REQUIRE(run_program(resume(folder, "s.sqlite")).exit_code == 0);
  Database(folder.path("s.sqlite"), Database::Open::existing).run("PRAGMA user_version = 99");
  refused("s.sqlite", 3, "version 99");
  Database(folder.path("s.sqlite"), Database::Open::existing)
      .run("PRAGMA user_version = 1; DELETE FROM frame WHERE run = 3; DELETE FROM run WHERE id = 3");
  {
    Database other(folder.path("s.sqlite"), Database::Open::existing);
    Database writer(folder.path("locked.sqlite"), Database::Open::create);
    writer.run("BEGIN EXCLUSIVE; CREATE TABLE song (title TEXT)");
    refused("locked.sqlite", 3, "locked by another program");
    writer.run("ROLLBACK");
  }
  REQUIRE(run_program(resume(folder, "s.sqlite")).exit_code == 0);
  REQUIRE(run_program(resume(folder, "whole.sqlite")).exit_code == 0);
  CHECK(content_of_store(folder.path("s.sqlite")) == content_of_store(folder.path("whole.sqlite")));
}

}  // namespace framesim
