// What names in a scene file stand for, where a name may be declared again and, in pbrt-v4, used
// before it is declared.
#pragma once

#include <algorithm>
#include <deque>
#include <iterator>
#include <map>
#include <string>
#include <utility>

namespace lockstep::pbrt {

// Everything declared or used has a rising number, its order in the file.
template <class T>
class NameTable {
 public:
  // The reference stays valid.
  T& declare(const std::string& name, int order, T value) {
    return declarations_[name].emplace_back(order, std::move(value)).second;
  }

  // What `name` stands for at `order`: the last declaration before it, else the first one after;
  // null where there is none.
  T* find(const std::string& name, int order) {
    const auto found = declarations_.find(name);
    if (found == declarations_.end()) return nullptr;
    auto& declared = found->second;
    const auto after = std::lower_bound(declared.begin(), declared.end(), order,
                                        [](const auto& d, int at) { return d.first < at; });
    return after == declared.begin() ? &after->second : &std::prev(after)->second;
  }

 private:
  std::map<std::string, std::deque<std::pair<int, T>>> declarations_;
};

}  // namespace lockstep::pbrt
