#include "sim/picture_recorder.h"

#include "tests/catch.h"

using namespace framesim;

namespace {

// Items of one type with four levels worth 1, 2, 3, 4.
struct Picture {
  std::vector<ObjectType> types = std::vector<ObjectType>(1);
  Workload workload;
  Selection selection;

  explicit Picture(const std::vector<std::uint32_t>& ids) {
    workload.types = types;
    workload.level_begin = {0};
    for (const std::uint32_t id : ids) {
      workload.id.push_back(InstanceId{id});
      workload.type.push_back(TypeId{0});
      workload.kind.push_back(ItemKind::levels);
      workload.level_begin.push_back(workload.level_begin.back() + 4);
      for (const double benefit : {1.0, 2.0, 3.0, 4.0}) workload.benefit.push_back(benefit);
    }
    selection.reset(ids.size());
  }
  Picture& draw(std::size_t item, std::int16_t level, double resolution = 1) {
    selection.level[item] = level;
    selection.resolution[item] = resolution;
    return *this;
  }
  FrameRecord record(PictureRecorder& recorder) const {
    FrameRecord record;
    recorder.record(workload, selection, record);
    return record;
  }
};

}  // namespace

// Level l of 0..3 is l/3 on the way from coarse to fine, times the share that is drawn: 1 | 2/3 | 1/3 | 0 | 3/3 * 0.6 |
// 2/3 * 0.5 = 1/3 | not drawn. Limits belong to the finer bin.
TEST_CASE("drawn items by fineness, by hand") {
  Picture picture({0, 1, 2, 3, 4, 5, 6});
  picture.draw(0, 3).draw(1, 2).draw(2, 1).draw(3, 0).draw(4, 3, 0.6).draw(5, 2, 0.5);
  picture.selection.planned_benefit = 12.5;
  PictureRecorder recorder;
  const FrameRecord r = picture.record(recorder);
  CHECK(r.drawn == 6);
  CHECK(r.mix_finest == 1);
  CHECK(r.mix_fine == 1);
  CHECK(r.mix_middle == 3);
  CHECK(r.mix_coarse == 1);
  CHECK(r.mix_none == 1);
  CHECK(r.benefit == 12.5);
  CHECK(r.finest_benefit == 28);
  CHECK(r.switches == 0);
}

// Frame 1: items 2, 5, 9. Frame 2: 2 as before, 5 changed, 9 gone, 3 new: one switch. Frame 3: 9 is back, with another
// level than when it was last seen, but it was not visible in frame 2; 3 is not drawn any more, which is a change.
TEST_CASE("a level switch is one of an item that was visible in the frame before") {
  PictureRecorder recorder;
  CHECK(Picture({2, 5, 9}).draw(0, 1).draw(1, 1).draw(2, 1).record(recorder).switches == 0);
  CHECK(Picture({2, 3, 5}).draw(0, 1).draw(1, 3).draw(2, 2).record(recorder).switches == 1);
  CHECK(Picture({3, 5, 9}).draw(1, 2).draw(2, 3).record(recorder).switches == 1);
  CHECK(Picture({}).record(recorder).switches == 0);
  CHECK(Picture({3, 5, 9}).draw(1, 0).draw(2, 0).record(recorder).switches == 0);
}

// A curve counts by the rung of its stand-ins, three by default 1/4, 1/2, 1: from 0.3 to 0.45 it stays between 1/4 and 1/2.
TEST_CASE("a curve switches where a ladder of stand-ins would") {
  PictureRecorder recorder;
  const auto frame = [&](double resolution) {
    Picture picture({4});
    picture.types[0].stand_in_levels = 3;
    picture.workload.kind[0] = ItemKind::curve;
    picture.workload.level_begin = {0, 1};
    return picture.draw(0, 0, resolution).record(recorder).switches;
  };
  frame(0.3);
  CHECK(frame(0.45) == 0);
  CHECK(frame(0.55) == 1);
  CHECK(frame(1) == 1);
}

// Root 0 over leaves 1 and 2, and a leaf 3 by itself. Drawn is the root: at its finest, but one level above leaves, so
// that it is 1 - 1/(1 + 1) = 1/2 on the way. The most that could be had is all leaves at their finest: 3 * 4.
TEST_CASE("in a tree a drawn node stands for its subtree, coarser than leaves") {
  Picture picture({0, 1, 2, 3});
  picture.workload.subtree_end = {3, 2, 3, 4};
  picture.draw(0, 3);
  PictureRecorder recorder;
  const FrameRecord r = picture.record(recorder);
  CHECK(r.drawn == 1);
  CHECK(r.mix_middle == 1);
  CHECK(r.mix_none == 1);
  CHECK(r.finest_benefit == 12);
}

// Of the items' levels 1, 2, 3, 4: in item 1 the second is made worth 9, as pricing a change of level does. 4 + 9.
TEST_CASE("a coarser level that is worth more than the finest counts in the most that a frame could have") {
  Picture picture({0, 1});
  picture.workload.benefit[5] = 9;
  PictureRecorder recorder;
  CHECK(picture.draw(0, 3).draw(1, 1).record(recorder).finest_benefit == 13);
}

// Root 0 over node 1 (over leaf 2) and leaf 3; leaf 4 by itself. Leaves at their finest are worth 4 each. Node 1 at 7 is worth
// more than its leaf: 7 + 4 + 4. The root at 12 is worth more than 7 + 4: 12 + 4. At 11 it is not: 7 + 4 + 4 again.
TEST_CASE("a node that is worth more than its subtree counts in the most that a frame could have") {
  Picture picture({0, 1, 2, 3, 4});
  picture.workload.subtree_end = {4, 3, 3, 4, 5};
  PictureRecorder recorder;
  picture.workload.benefit[7] = 7;
  CHECK(picture.draw(2, 3).record(recorder).finest_benefit == 15);
  picture.workload.benefit[0] = 12;  // its coarsest level
  CHECK(picture.record(recorder).finest_benefit == 16);
  picture.workload.benefit[0] = 11;
  CHECK(picture.record(recorder).finest_benefit == 15);
}

// A bundle over two leaves has no level of its own.
TEST_CASE("a bundle is worth its leaves in the most that a frame could have") {
  Picture picture({0, 1, 2});
  picture.workload.subtree_end = {3, 2, 3};
  picture.workload.kind[0] = ItemKind::bundle;
  picture.workload.level_begin = {0, 0, 4, 8};
  PictureRecorder recorder;
  CHECK(picture.draw(1, 3).record(recorder).finest_benefit == 8);
}
