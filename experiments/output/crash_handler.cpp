// Nothing here that a signal handler runs allocates, locks or calls what is not async-signal-safe.
#include "experiments/output/crash_handler.h"

#include "experiments/output/activity.h"
#include "experiments/output/command_line.h"
#include "packets/render_site.h"
#include "packets/signal_stack.h"

#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <string>
#include <string_view>

namespace lockstep {
namespace {

struct CaughtSignal {
  int number;
  const char* text;
};
constexpr CaughtSignal caught_signals[] = {{SIGSEGV, "SIGSEGV, memory that it may not touch"},
                                           {SIGBUS, "SIGBUS, memory that is not there"},
                                           {SIGFPE, "SIGFPE, an impossible calculation"},
                                           {SIGILL, "SIGILL, an instruction unknown to this CPU"},
                                           {SIGABRT, "SIGABRT, the program gave up"}};

// Made before anything can crash.
char own_command[4096] = "";

std::atomic<pid_t> reporter = 0;            // the thread that prints, once there is one
thread_local char uncaught_text[512] = "";  // what() of an exception that nobody caught

// Text that is written to stderr when it is full and when it ends.
class Block {
 public:
  ~Block() { flush(); }
  Block& operator<<(std::string_view text) {
    for (const char c : text) {
      if (size_ == sizeof text_) flush();
      text_[size_++] = c;
    }
    return *this;
  }
  Block& operator<<(std::uint64_t number) { return add(number, 10); }
  Block& hexadecimal(std::uint64_t number) { return *this << "0x", add(number, 16); }

 private:
  Block& add(std::uint64_t number, int base) {
    char digits[24];
    const char* end = std::to_chars(digits, digits + sizeof digits, number, base).ptr;
    return *this << std::string_view(digits, std::size_t(end - digits));
  }
  void flush() {
    for (std::size_t at = 0; at < size_;) {
      const ssize_t written = ::write(STDERR_FILENO, text_ + at, size_ - at);
      if (written <= 0) break;
      at += std::size_t(written);
    }
    size_ = 0;
  }
  char text_[1024];
  std::size_t size_ = 0;
};

void print_site(Block& out, const RenderSite& site) {
  out << "  render   " << site.render << "\n";
  if (site.samples == 0) return;
  out << "  where    pixels (" << std::uint64_t(site.x0) << ", " << std::uint64_t(site.y0)
      << ") to (" << std::uint64_t(site.x1 - 1) << ", " << std::uint64_t(site.y1 - 1)
      << "), samples " << site.first_sample << " to " << site.first_sample + site.samples - 1
      << ", bounce " << std::uint64_t(site.bounce) << "\n";
}

void print_block(int signal, const siginfo_t* info) {
  Block out;
  out << "lockstep: crashed";
  for (const CaughtSignal& caught : caught_signals) {
    if (caught.number == signal) out << ": " << caught.text;
  }
  // Only a fault has an address; a signal that was sent has a sender.
  if (info->si_code > 0 && signal != SIGABRT) {
    out << " (address ";
    out.hexadecimal(reinterpret_cast<std::uintptr_t>(info->si_addr)) << ")";
  }
  if (info->si_code <= 0 && info->si_pid != getpid()) {
    out << "; sent by process " << std::uint64_t(info->si_pid) << "\n";
  } else {
    out << "; this is a defect of lockstep\n";
  }
  if (uncaught_text[0] != '\0') out << "  error    " << uncaught_text << "\n";
  const RenderSite& site = render_site();
  if (site.render) {
    print_site(out, site);
  } else if (const char* activity = current_activity(); *activity != '\0') {
    out << "  during   " << activity << "\n";
  }
  const bool narrower = site.render && site.command && *site.command != '\0';
  out << "  again    " << (narrower ? site.command : own_command) << "\n";
}

// One thread prints; others that crash meanwhile wait for it to end the process, but not for ever.
void on_crash(int signal, siginfo_t* info, void*) {
  const int error = errno;
  const auto self = pid_t(syscall(SYS_gettid));
  pid_t nobody = 0;
  if (reporter.compare_exchange_strong(nobody, self)) {
    print_block(signal, info);
  } else if (nobody != self) {
    const timespec patience{2, 0};
    nanosleep(&patience, nullptr);
  }
  errno = error;
  // Its default action, once this handler has returned.
  std::signal(signal, SIG_DFL);
  raise(signal);
}

void copy(std::string_view text, char* to, std::size_t room) {
  const std::size_t size = std::min(text.size(), room - 1);
  std::memcpy(to, text.data(), size);
  to[size] = '\0';
}

[[noreturn]] void on_terminate() {
  try {
    if (std::exception_ptr exception = std::current_exception()) std::rethrow_exception(exception);
    copy("terminated without an exception", uncaught_text, sizeof uncaught_text);
  } catch (const std::exception& error) {
    copy(error.what(), uncaught_text, sizeof uncaught_text);
  } catch (...) {
    copy("an exception of an unknown kind", uncaught_text, sizeof uncaught_text);
  }
  std::abort();
}

}  // namespace

void catch_crashes() {
  copy(own_command_line(), own_command, sizeof own_command);
  give_signal_stack();
  struct sigaction action {};
  action.sa_sigaction = on_crash;
  action.sa_flags = SA_SIGINFO | SA_ONSTACK;
  sigemptyset(&action.sa_mask);
  for (const CaughtSignal& caught : caught_signals) {
    struct sigaction before {};
    sigaction(caught.number, nullptr, &before);
    if (before.sa_handler == SIG_DFL) sigaction(caught.number, &action, nullptr);
  }
  std::set_terminate(on_terminate);
}

}  // namespace lockstep
