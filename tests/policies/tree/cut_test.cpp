#include "policies/tree/cut.h"

#include <vector>

#include "policies/tree/step.h"
#include "tests/catch.h"
#include "tests/policies/make_policy.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

// root (1,10) over a bundle of {a (1,8) over {(1,7), (1,7)}} and b, levels (1,6), (3,9). Items: root 0, bundle 1, a 2, 3, 4, b 5.
TestWorkload small_tree() {
  TestWorkload w;
  const auto root = w.add_item({{1, 10}});
  const auto bundle = w.add_bundle();
  const auto a = w.add_item({{1, 8}});
  w.add_item({{1, 7}});
  w.add_item({{1, 7}});
  w.close(a);
  w.close(bundle);
  w.add_item({{1, 6}, {3, 9}});
  w.close(root);
  w.finish();
  return w;
}

constexpr std::int16_t no = kNotDrawn;

}  // namespace

TEST_CASE("cut: successors are the nearest nodes below, through bundles") {
  const TestWorkload w = small_tree();
  Selection s;
  s.reset(w.workload.size());
  Cut cut;
  cut.start(w.workload, 9, s);
  std::vector<std::size_t> top, below;
  cut.for_top_nodes([&](std::size_t i) { top.push_back(i); });
  cut.for_successors(0, [&](std::size_t i) { below.push_back(i); });
  CHECK(top == std::vector<std::size_t>{0});
  CHECK(below == std::vector<std::size_t>{2, 5});
  CHECK_FALSE(cut.is_node(1));
  CHECK_FALSE(cut.has_successors(5));
}

TEST_CASE("cut: opening, closing and undoing keep the sums") {
  const TestWorkload w = small_tree();
  Selection s;
  s.reset(w.workload.size());
  Cut cut;
  cut.start(w.workload, 9, s);
  cut.draw(0, 0);
  CHECK(cut.left_s() == 8);
  cut.mark();
  cut.open(0, 2);
  CHECK(s.level == Levels{no, no, no, 0, 0, 0});
  CHECK(cut.left_s() == 6);      // 1 + 1 + 1
  CHECK(cut.benefit() == 20);    // 7 + 7 + 6
  CHECK_FALSE(cut.closable(0));  // a is open
  CHECK(cut.closable(2));
  CHECK(cut.present(2).benefit == 14);
  cut.draw(5, 1);
  cut.close(2, 0);
  CHECK(cut.closable(0));
  CHECK(cut.present(0).cost_s == 4);    // 1 + 3
  CHECK(cut.present(0).benefit == 17);  // 8 + 9
  cut.undo();
  CHECK(s.level == Levels{0, no, no, no, no, no});
  CHECK(cut.left_s() == 8);
  CHECK(cut.benefit() == 10);
  CHECK(cut.changes().empty());
}

// From the root: the children cost 2 and give 14, +4 for +1; two steps down 3 and 20, +10 for +2, value 5.
TEST_CASE("cut: steps and what they are worth") {
  const TestWorkload w = small_tree();
  Selection s;
  s.reset(w.workload.size());
  Cut cut;
  cut.start(w.workload, 9, s);
  cut.draw(0, 0);
  CHECK(next_raise(cut, 0).value == 4);
  CHECK(best_raise(cut, 0, 1).value == 4);
  const Step deep = best_raise(cut, 0, 2);
  CHECK(deep.value == 5);
  CHECK(deep.depth == 2);
  CHECK(best_raise(cut, 0, 2, 1.5).depth == 1);
  CHECK_FALSE(best_raise(cut, 0, 2, 0.5));
  CHECK_FALSE(best_lowering(cut, 0, false));
  const Step out = best_lowering(cut, 0, true);
  CHECK(out.to == kLeftOut);
  CHECK(out.value == 10);
  take(cut, 0, deep);
  // b: 3 more for 2 more. Closing a: 14 - 8 lost for 1 saved; the root cannot be closed over an open child.
  CHECK(next_raise(cut, 5).value == 1.5);
  CHECK(next_lowering(cut, 2, true).value == 6);
  CHECK_FALSE(best_lowering(cut, 0, true));
  take(cut, 2, best_lowering(cut, 2, false));
  take(cut, 5, next_raise(cut, 5));
  CHECK_FALSE(next_lowering(cut, 0, false));             // b is not at its coarsest
  CHECK(best_lowering(cut, 0, false).value == 7.0 / 3);  // 17 - 10 for 4 - 1
}
