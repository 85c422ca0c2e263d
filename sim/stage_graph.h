// The frame as a graph of stages: what must end before what may begin. Boost.Graph shows in stage_graph.cpp only.
//
// A frame has the stages logic -> visibility -> decide -> submit -> primitive -> pixel -> present; a scene may declare
// logic tasks (physics, AI, streaming) that run beside each other, each after the tasks it names, between the start of the
// frame and `logic`. The graph is checked for cycles once, when it is built.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/check.h"
#include "sim/units.h"

namespace framesim {

// The stages every frame has, in their order.
enum class Stage : std::uint8_t { logic, visibility, decide, submit, primitive, pixel, present };
inline constexpr std::size_t kStageCount = 7;
inline constexpr std::string_view kStageNames[kStageCount] = {"logic",     "visibility", "decide", "submit",
                                                              "primitive", "pixel",      "present"};

struct LogicTask {
  std::string name;
  double time_s = 0;
  std::vector<std::string> after;
  InputLocation where;  // for messages
};

// base + per_item * visible items, and beside it the declared tasks on as many workers as they need.
struct LogicLoad {
  double base_s = 0;
  double per_item_s = 0;
  std::vector<LogicTask> tasks;
};

class StageGraph {
 public:
  // Throws InputError at the task's location for a cycle (naming the tasks on it), an unknown or repeated name, or a task
  // with the name of a stage.
  explicit StageGraph(const std::vector<LogicTask>& tasks);

  // All nodes (tasks and stages) in one topological order; ties by order of declaration: nodes come in order of number, each
  // right after those of the nodes it waits for that have not come yet. Numbers: the tasks as declared, then the stages.
  const std::vector<int>& order() const { return order_; }
  const std::string& name(int node) const { return names_[static_cast<std::size_t>(node)]; }
  int node(Stage stage) const;
  // The stage that `node` is; nothing for a task.
  std::optional<Stage> stage(int node) const;
  int size() const { return static_cast<int>(names_.size()); }

  struct Path {
    Picoseconds length{0};
    std::vector<int> nodes;  // from the start of the frame to its end
  };
  // The longest path through the graph when node i takes durations[i]; ties prefer the node declared first.
  Path critical_path(const std::vector<Picoseconds>& durations) const;
  // Length of the longest path through the declared tasks alone; 0 without tasks.
  Picoseconds task_time() const { return task_time_; }
  // What each node takes by declaration: tasks their time, stages 0.
  const std::vector<Picoseconds>& declared_times() const { return task_durations_; }

 private:
  std::vector<std::string> names_;
  std::vector<std::vector<int>> predecessors_;
  std::vector<int> order_;
  std::vector<Picoseconds> task_durations_;
  Picoseconds task_time_{0};
};

}  // namespace framesim
