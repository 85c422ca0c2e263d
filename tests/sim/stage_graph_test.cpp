#include "sim/stage_graph.h"

#include <algorithm>
#include <functional>
#include <string>

#include "tests/catch.h"
#include "tests/sim/random_pipeline.h"

using namespace framesim;
using framesim::test::SplitMix;

namespace {

LogicTask task(const std::string& name, double time_s, std::vector<std::string> after = {}, int line = 1) {
  return {.name = name, .time_s = time_s, .after = std::move(after), .where = {"scene.toml", line, 1}};
}

std::vector<std::string> names(const StageGraph& graph, const std::vector<int>& nodes) {
  std::vector<std::string> result;
  for (const int node : nodes) result.push_back(graph.name(node));
  return result;
}
using Names = std::vector<std::string>;

std::string refusal(const std::vector<LogicTask>& tasks) {
  try {
    const StageGraph graph(tasks);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("a frame without tasks is the seven stages in their order") {
  const StageGraph graph({});
  CHECK(names(graph, graph.order()) ==
        Names{"logic", "visibility", "decide", "submit", "primitive", "pixel", "present"});
  CHECK(graph.task_time() == Picoseconds(0));
  CHECK(graph.node(Stage::logic) == 0);
  CHECK(graph.name(graph.node(Stage::present)) == "present");
  // 1 + 2 + ... + 7 = 28
  const StageGraph::Path path = graph.critical_path(
      {Picoseconds(1), Picoseconds(2), Picoseconds(3), Picoseconds(4), Picoseconds(5), Picoseconds(6), Picoseconds(7)});
  CHECK(path.length == Picoseconds(28));
  CHECK(path.nodes == graph.order());
}

TEST_CASE("tasks come in order of declaration, each after those it waits for") {
  // physics waits for input and stream, which are declared later: they are drawn forward, in order of declaration.
  const StageGraph graph(
      {task("ai", 0), task("physics", 0, {"stream", "input"}), task("input", 0), task("stream", 0), task("sound", 0)});
  CHECK(names(graph, graph.order()) == Names{"ai", "input", "stream", "physics", "sound", "logic", "visibility",
                                             "decide", "submit", "primitive", "pixel", "present"});
}

// a 1 us, b 2 us after a, c 4 us after a, d 1 us after b and c, e 5.5 us alone: a-c-d takes 6 us, more than e.
TEST_CASE("the tasks' time is their longest path, derived by hand") {
  const StageGraph graph({task("a", 1e-6), task("b", 2e-6, {"a"}), task("c", 4e-6, {"a"}), task("d", 1e-6, {"b", "c"}),
                          task("e", 5.5e-6)});
  CHECK(graph.task_time() == Picoseconds(6'000'000));
  std::vector<Picoseconds> durations(static_cast<std::size_t>(graph.size()), Picoseconds(10));
  CHECK(names(graph, graph.critical_path(durations).nodes) == Names{"a", "b", "d", "logic", "visibility", "decide",
                                                                    "submit", "primitive", "pixel",
                                                                    "present"});  // b ties with c
  CHECK(graph.critical_path(durations).length == Picoseconds(100));
  durations[4] = Picoseconds(31);  // e alone now takes longer than a, b, d
  CHECK(graph.critical_path(durations).length == Picoseconds(101));
  CHECK(graph.name(graph.critical_path(durations).nodes.front()) == "e");
}

TEST_CASE("tasks that wait for each other are refused by name, where the first of them is declared") {
  // The search comes from sound to physics, and enters the circle there; it is told from ai all the same.
  const std::string message = refusal({task("sound", 0, {"physics"}, 3), task("ai", 0, {"physics"}, 4),
                                       task("stream", 0, {}, 5), task("physics", 0, {"ai"}, 6)});
  CAPTURE(message);
  CHECK(contains(message, "scene.toml:4:1"));
  CHECK(contains(message, "'ai' after 'physics' after 'ai'"));
  CHECK_FALSE(contains(message, "sound"));  // waits for the circle, but is not on it
  CHECK(contains(refusal({task("loop", 0, {"loop"})}), "'loop' after 'loop'"));
  // c waits for a, a for b, b for c: told from a, the one declared first.
  CHECK(contains(refusal({task("a", 0, {"b"}), task("b", 0, {"c"}), task("c", 0, {"a"})}),
                 "'a' after 'b' after 'c' after 'a'"));
}

TEST_CASE("unknown, repeated and reserved names are refused with what is allowed") {
  const std::string unknown = refusal({task("physics", 0), task("ai", 0, {"phisics"}, 9)});
  CAPTURE(unknown);
  CHECK(contains(unknown, "scene.toml:9:1"));
  CHECK(contains(unknown, "'phisics'"));
  CHECK(contains(unknown, "physics, ai"));
  CHECK(contains(refusal({task("ai", 0, {}, 1), task("ai", 0, {}, 2)}),
                 "scene.toml:2:1: there are two tasks 'ai'; the first is at scene.toml:1:1"));
  CHECK(contains(refusal({task("submit", 0)}), "logic, visibility, decide"));
  CHECK(contains(refusal({task("ai", 0, {"logic"})}), "'logic'"));  // a task comes before every stage
}

TEST_CASE("naming the same task twice in after is one wait") {
  CHECK(StageGraph({task("a", 1e-6), task("b", 1e-6, {"a", "a"})}).task_time() == Picoseconds(2'000'000));
}

TEST_CASE("durations that are not one a node are refused") {
  CHECK_THROWS_AS(StageGraph({}).critical_path({Picoseconds(1)}), InternalError);
}

// Reference: the longest path by plain recursion over what each task waits for.
TEST_CASE("random task graphs: order, longest path and cycles agree with plain recursion") {
  int cyclic = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    CAPTURE(seed);
    SplitMix random(seed);
    const std::int64_t count = random.between(1, 12);
    std::vector<LogicTask> tasks;
    for (std::int64_t i = 0; i < count; ++i)
      tasks.push_back(task("t" + std::to_string(i), static_cast<double>(random.between(0, 9)) * 1e-6));
    std::vector<std::vector<std::size_t>> waits(tasks.size());
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      for (std::size_t j = 0; j < tasks.size(); ++j) {
        // Mostly from high to low along a scrambled numbering, which has no cycle; now and then the other way round.
        const bool forward = (i * 7 + 3) % 13 > (j * 7 + 3) % 13;
        if (i != j && random.chance(forward ? 25 : 1)) waits[i].push_back(j);
      }
      for (const std::size_t j : waits[i]) tasks[i].after.push_back(tasks[j].name);
    }
    std::vector<int> depth(tasks.size(), 0);
    bool cycle = false;
    const std::function<std::int64_t(std::size_t)> length = [&](std::size_t i) -> std::int64_t {
      if (depth[i] > 0) cycle = true;
      if (cycle) return 0;
      depth[i] = 1;
      std::int64_t longest = 0;
      for (const std::size_t j : waits[i]) longest = std::max(longest, length(j));
      depth[i] = 0;
      return longest + ceil_picoseconds(tasks[i].time_s).count();
    };
    std::int64_t expected = 0;
    for (std::size_t i = 0; i < tasks.size(); ++i) expected = std::max(expected, length(i));
    if (cycle) {
      ++cyclic;
      CHECK_THROWS_AS(StageGraph(tasks), InputError);
      continue;
    }
    const StageGraph graph(tasks);
    CHECK(graph.task_time().count() == expected);
    REQUIRE(graph.order().size() == tasks.size() + kStageCount);
    const auto position = [&](std::size_t i) {
      return std::find(graph.order().begin(), graph.order().end(), static_cast<int>(i)) - graph.order().begin();
    };
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      for (const std::size_t j : waits[i]) CHECK(position(j) < position(i));
    }
  }
  CHECK(cyclic > 20);
  CHECK(cyclic < 380);
}
