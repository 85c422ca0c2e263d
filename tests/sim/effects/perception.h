// Workloads for the tests of the perception effects: a few items, each of a type of its own.
#pragma once

#include <algorithm>
#include <memory>

#include "sim/benefit.h"
#include "sim/effect.h"

namespace framesim::testing {

inline std::unique_ptr<Effect> make_effect(std::string_view spec_text) {
  const Spec spec = parse_spec(spec_text);
  return find_entry<EffectEntry>("effect", effects(), spec).make(spec.settings, 1);
}

// A level that is worth `benefit`, whatever it looks like.
inline Facts worth(double benefit) {
  Facts facts;
  facts.stated_benefit = benefit;
  return facts;
}

// The items are visible in every frame unless `hide` says otherwise.
class Sights {
 public:
  SceneFacts scene;

  // Returns the item's index, which is its id too.
  std::size_t add(ObjectType type, double area_px = 100, double angle_rad = 0, ItemKind kind = ItemKind::levels) {
    scene.types.push_back(std::move(type));
    area_px_.push_back(area_px);
    angle_rad_.push_back(angle_rad);
    kind_.push_back(kind);
    hidden_.push_back(false);
    scene.instances = scene.types.size();
    return scene.instances - 1;
  }

  void look(std::size_t id, double area_px, double angle_rad) {
    area_px_[id] = area_px;
    angle_rad_[id] = angle_rad;
  }
  void hide(std::size_t id, bool hidden = true) { hidden_[id] = hidden; }

  // What is seen now, with the benefit of the model.
  Workload scored() const {
    Workload w;
    w.types = scene.types;
    w.level_begin = {0};
    for (std::uint32_t id = 0; id < scene.instances; ++id) {
      const auto begin = static_cast<std::uint32_t>(w.facts.size());
      const std::vector<Facts>& levels = scene.types[id].levels;
      w.facts.insert(w.facts.end(), levels.begin(), levels.end());
      if (hidden_[id]) continue;
      w.id.push_back(InstanceId{id});
      w.type.push_back(static_cast<TypeId>(id));
      w.kind.push_back(kind_[id]);
      w.projected_area_px.push_back(area_px_[id]);
      w.view_angle_rad.push_back(angle_rad_[id]);
      w.facts_begin.push_back(begin);
      const std::size_t count = kind_[id] == ItemKind::bundle ? 0 : levels.size();
      w.level_begin.push_back(w.level_begin.back() + static_cast<std::uint32_t>(count));
    }
    w.static_facts = static_cast<std::uint32_t>(w.facts.size());
    w.benefit.resize(w.level_begin.back());
    score(w);
    return w;
  }

  void prepare(Effect& effect) const { effect.prepare({machine_, scene, logic_}); }
  std::optional<std::string> inert(const Effect& effect) const { return effect.inert({machine_, scene, logic_}); }

  // The benefits that `effect` leaves in this frame.
  std::vector<double> seen(Effect& effect, std::int64_t frame) const {
    Workload w = scored();
    effect.on_workload(frame, w);
    return w.benefit;
  }

  // One frame with these levels drawn, one for each item that is seen. Returns its benefits.
  std::vector<double> drawn(Effect& effect, std::int64_t frame, const std::vector<std::int16_t>& levels) const {
    Workload w = scored();
    effect.on_workload(frame, w);
    Selection selection;
    selection.reset(w.size());
    selection.level = levels;
    for (std::size_t i = 0; i < levels.size(); ++i) selection.resolution[i] = levels[i] == kNotDrawn ? 0 : 1;
    const Machine machine(machine_);
    CommandColumns commands;
    if (has(effect.hooks(), Hook::commands)) {
      effect.on_commands({.frame = frame, .workload = w, .selection = selection, .machine = machine}, commands);
    }
    return w.benefit;
  }

 private:
  MachineProfile machine_;
  LogicLoad logic_;
  std::vector<double> area_px_, angle_rad_;
  std::vector<ItemKind> kind_;
  std::vector<bool> hidden_;
};

}  // namespace framesim::testing
