// Runs a fuzz target without libFuzzer: replay FOLDER MUTATIONS reads every file of FOLDER and so
// many damaged copies of each, within limits of memory and time. Exit status 0 where all is well;
// else the input that broke the reader is left in the working directory and named.
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/mutate.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace lockstep::fuzz {
namespace {

constexpr time_t most_seconds = 10;              // of a processor, per input
constexpr unsigned longest_wait = 300;           // seconds by the clock: one that waits for ever
constexpr rlim_t most_memory = rlim_t(2) << 30;  // address space
constexpr std::size_t signal_stack_size = 1 << 16;

#if defined(__SANITIZE_ADDRESS__)
constexpr bool sanitized = true;  // needs terabytes of address space
#else
constexpr bool sanitized = false;
#endif

// What the signal handler saves.
struct Current {
  const char* bytes = nullptr;
  std::size_t size = 0;
  char file[64] = "";
};
Current current;

void say(const char* text) {
  if (write(STDERR_FILENO, text, std::strlen(text)) < 0) _exit(3);
}

void on_signal(int signal) {
  const int file = open(current.file, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  const bool saved = file >= 0 && write(file, current.bytes, current.size) >= 0;
  say(signal == SIGPROF   ? "too slow"
      : signal == SIGALRM ? "hangs"
      : signal == SIGSEGV ? "segmentation fault"
                          : "aborted");
  say(saved ? "; the input is saved as " : "; the input cannot be saved as ");
  say(current.file);
  say("\n");
  _exit(1);
}

void install_limits() {
  static char stack[signal_stack_size];  // the ordinary one may have overflown
  stack_t alternative{};
  alternative.ss_sp = stack;
  alternative.ss_size = sizeof(stack);
  sigaltstack(&alternative, nullptr);
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_ONSTACK;
  for (const int signal : {SIGABRT, SIGALRM, SIGPROF, SIGSEGV, SIGFPE, SIGBUS, SIGILL}) {
    sigaction(signal, &action, nullptr);
  }
  const rlimit memory{most_memory, most_memory};
  if (!sanitized) setrlimit(RLIMIT_AS, &memory);
}

std::vector<std::string> read_corpus(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) paths.push_back(entry);
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> corpus;
  for (const auto& path : paths) {
    std::ifstream file(path, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return corpus;
}

// Zeros: no limits.
void limit_time(time_t processor, unsigned clock) {
  const itimerval left{{}, {processor, 0}};
  setitimer(ITIMER_PROF, &left, nullptr);
  alarm(clock);
}

void run(const std::string& input) {
  current.bytes = input.data();
  current.size = input.size();
  limit_time(most_seconds, longest_wait);
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
  limit_time(0, 0);
}

}  // namespace
}  // namespace lockstep::fuzz

int main(int argument_count, char** arguments) {
  using namespace lockstep::fuzz;
  if (argument_count != 3) {
    std::fprintf(stderr, "usage: %s FOLDER MUTATIONS\n", arguments[0]);
    return 2;
  }
  const std::vector<std::string> corpus = read_corpus(arguments[1]);
  if (corpus.empty()) {
    std::fprintf(stderr, "%s: no files\n", arguments[1]);
    return 2;
  }
  install_limits();
  std::snprintf(current.file, sizeof(current.file), "fuzz-failure-%d", int(getpid()));
  for (const std::string& input : corpus) run(input);
  Random random(1);
  for (int i = std::atoi(arguments[2]); i > 0; --i) {
    for (std::size_t k = 0; k < corpus.size(); ++k) run(mutated(corpus, k, random));
  }
  return 0;
}
