#include "sim/stage_graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/depth_first_search.hpp>
#include <boost/graph/topological_sort.hpp>
#include <iterator>

#include "sim/clock.h"
#include "sim/words.h"

namespace framesim {
namespace {

// An edge leads from a node to one that it waits for. That way round, the order in which a depth-first search leaves
// the nodes is a topological order, and it meets nodes in order of declaration.
using WaitsFor = boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS>;

WaitsFor make_graph(const std::vector<std::vector<int>>& predecessors) {
  WaitsFor graph(predecessors.size());
  for (std::size_t node = 0; node < predecessors.size(); ++node) {
    for (const int earlier : predecessors[node]) boost::add_edge(node, static_cast<std::size_t>(earlier), graph);
  }
  return graph;
}

// Keeps the nodes on the current path of the search, and the first cycle that an edge back to that path closes.
class CycleFinder : public boost::default_dfs_visitor {
 public:
  CycleFinder(std::vector<int>& path, std::vector<int>& cycle) : path_(&path), cycle_(&cycle) {}

  void discover_vertex(WaitsFor::vertex_descriptor node, const WaitsFor&) { path_->push_back(static_cast<int>(node)); }
  void finish_vertex(WaitsFor::vertex_descriptor, const WaitsFor&) { path_->pop_back(); }
  void back_edge(WaitsFor::edge_descriptor edge, const WaitsFor& graph) {
    if (!cycle_->empty()) return;
    const int closing = static_cast<int>(boost::target(edge, graph));
    cycle_->assign(std::find(path_->begin(), path_->end(), closing), path_->end());
  }

 private:
  std::vector<int>* path_;  // pointers: Boost.Graph copies its visitors
  std::vector<int>* cycle_;
};

// The nodes of one cycle, each waiting for the next and the last for the first, from the one declared first; or none.
std::vector<int> find_cycle(const WaitsFor& graph) {
  std::vector<int> path, cycle;
  boost::depth_first_search(graph, boost::visitor(CycleFinder(path, cycle)));
  std::rotate(cycle.begin(), std::min_element(cycle.begin(), cycle.end()), cycle.end());
  return cycle;
}

[[noreturn]] void refuse_cycle(const std::vector<int>& cycle, const std::vector<LogicTask>& tasks) {
  const auto task = [&](int node) -> const LogicTask& { return tasks.at(static_cast<std::size_t>(node)); };
  std::string text = quoted(task(cycle.front()).name);
  for (std::size_t i = 1; i <= cycle.size(); ++i) text += " after " + quoted(task(cycle[i % cycle.size()]).name);
  throw InputError(task(cycle.front()).where, fmt::format("the tasks wait for each other in a circle: {}", text));
}

void check_names(const std::vector<LogicTask>& tasks) {
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const LogicTask& task = tasks[i];
    if (std::find(std::begin(kStageNames), std::end(kStageNames), task.name) != std::end(kStageNames)) {
      throw InputError(task.where, fmt::format("task {} has the name of a stage; every frame has the stages {}",
                                               quoted(task.name), list_of(kStageNames)));
    }
    const auto same_name = [&](const LogicTask& other) { return other.name == task.name; };
    const auto here = tasks.begin() + static_cast<std::ptrdiff_t>(i);
    if (const auto first = std::find_if(tasks.begin(), here, same_name); first != here) {
      throw InputError(task.where, fmt::format("there are two tasks {}; the first is at {}", quoted(task.name),
                                               to_string(first->where)));
    }
  }
}

int find_task(const std::vector<LogicTask>& tasks, const LogicTask& task, const std::string& wanted) {
  std::vector<std::string_view> known;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (tasks[i].name == wanted) return static_cast<int>(i);
    known.push_back(tasks[i].name);
  }
  throw InputError(task.where,
                   fmt::format("task {} is after {}, which is no task; the tasks are {}{}", quoted(task.name),
                               quoted(wanted), list_of(known), did_you_mean(wanted, known)));
}

}  // namespace

StageGraph::StageGraph(const std::vector<LogicTask>& tasks) {
  check_names(tasks);
  for (const LogicTask& task : tasks) {
    names_.push_back(task.name);
    task_durations_.push_back(ceil_picoseconds(task.time_s));
    std::vector<int>& predecessors = predecessors_.emplace_back();
    for (const std::string& earlier : task.after) predecessors.push_back(find_task(tasks, task, earlier));
    std::sort(predecessors.begin(), predecessors.end());
    predecessors.erase(std::unique(predecessors.begin(), predecessors.end()), predecessors.end());
  }
  for (const std::string_view stage : kStageNames) {
    std::vector<int>& predecessors = predecessors_.emplace_back();
    if (names_.size() > tasks.size()) {
      predecessors.push_back(size() - 1);
    } else {  // the first stage waits for every task
      for (int i = 0; i < size(); ++i) predecessors.push_back(i);
    }
    names_.emplace_back(stage);
    task_durations_.push_back(Picoseconds(0));
  }
  const WaitsFor graph = make_graph(predecessors_);
  if (const std::vector<int> cycle = find_cycle(graph); !cycle.empty()) refuse_cycle(cycle, tasks);
  boost::topological_sort(graph, std::back_inserter(order_));
  task_time_ = critical_path(task_durations_).length;
}

int StageGraph::node(Stage stage) const { return size() - static_cast<int>(kStageCount) + static_cast<int>(stage); }

std::optional<Stage> StageGraph::stage(int node) const {
  const int first = size() - static_cast<int>(kStageCount);
  return node < first ? std::nullopt : std::optional(static_cast<Stage>(node - first));
}

// One pass in topological order (longest path of an acyclic graph, O(nodes + edges)). All lead to the last stage.
StageGraph::Path StageGraph::critical_path(const std::vector<Picoseconds>& durations) const {
  FRAMESIM_CHECK(durations.size() == names_.size(),
                 fmt::format("{} durations for {} nodes", durations.size(), names_.size()));
  std::vector<Picoseconds> end(names_.size(), Picoseconds(0));
  std::vector<int> before(names_.size(), -1);
  for (const int node : order_) {
    const auto n = static_cast<std::size_t>(node);
    for (const int earlier : predecessors_[n]) {  // ascending, so that > prefers the one declared first
      if (before[n] < 0 || end[static_cast<std::size_t>(earlier)] > end[static_cast<std::size_t>(before[n])]) {
        before[n] = earlier;
      }
    }
    const Picoseconds start = before[n] < 0 ? Picoseconds(0) : end[static_cast<std::size_t>(before[n])];
    end[n] = advance(start, durations[n]);
  }
  Path path{.length = end.back(), .nodes = {}};
  for (int node = size() - 1; node >= 0; node = before[static_cast<std::size_t>(node)]) path.nodes.push_back(node);
  std::reverse(path.nodes.begin(), path.nodes.end());
  return path;
}

}  // namespace framesim
