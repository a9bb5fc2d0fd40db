// The tiles of one render, spread over ranks.
#pragma once

#include "experiments/distributed/desk.h"
#include "packets/shared_render.h"

#include <nlohmann/json.hpp>

#include <functional>
#include <memory>
#include <string>

namespace lockstep {

// For rank 0: lets the desk's ranks help with renders. What they have to know of this one is
// `render`; each of them has so many threads.
TileSharing share_tiles(Desk& desk, const nlohmann::json& render, int threads);

// What a rank other than 0 can do.
struct Skills {
  // First of all.
  std::function<void()> prepare;
  // Gets ready for tiles of a render.
  std::function<std::unique_ptr<TileRenderer>(const nlohmann::json& render)> join;
  std::function<void(const nlohmann::json& unit)> unit;
};

// For all other ranks: does what rank 0 asks for, until it asks for no more. What goes wrong is
// told rank 0.
void help(const Skills& skills);

// For a rank that measures: sends a line of the journal to rank 0.
void send_record(const std::string& line);

// To be called from time to time by a rank that works: rank 0 sees that it does.
void say_alive();

}  // namespace lockstep
