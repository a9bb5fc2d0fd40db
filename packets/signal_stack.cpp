#include "packets/signal_stack.h"

#include <csignal>
#include <cstddef>
#include <memory>
#include <new>

namespace lockstep {
namespace {

class SignalStack {
 public:
  SignalStack() noexcept {
    stack_t present{};
    if (sigaltstack(nullptr, &present) != 0 || !(present.ss_flags & SS_DISABLE)) return;
    memory_.reset(new (std::nothrow) char[size]);
    if (!memory_) return;
    stack_t stack{};
    stack.ss_sp = memory_.get();
    stack.ss_size = size;
    sigaltstack(&stack, nullptr);
  }
  ~SignalStack() {
    if (!memory_) return;
    stack_t none{};
    none.ss_flags = SS_DISABLE;
    sigaltstack(&none, nullptr);
  }
  SignalStack(const SignalStack&) = delete;
  SignalStack& operator=(const SignalStack&) = delete;

 private:
  static constexpr std::size_t size = 1 << 16;
  std::unique_ptr<char[]> memory_;
};

}  // namespace

void give_signal_stack() noexcept { thread_local const SignalStack stack; }

}  // namespace lockstep
