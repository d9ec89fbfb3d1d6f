// Preloaded into a program, writes a line for each machine instruction of frond's own code that raises "invalid
// operation": 0/0, inf - inf, 0 * inf, the root of a negative number, a comparison of NaN by <. An instruction of
// another library, such as Embree's, is carried out as if there were no trap. Lines (module and offset in it) are
// appended to the file that FROND_TRAPS_LOG names.
#include <dlfcn.h>
#include <fcntl.h>
#include <fenv.h>
#include <ucontext.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

constexpr unsigned kInvalidFlag = 1, kInvalidMask = 1U << 7;  // bits of MXCSR
constexpr greg_t kTrapFlag = 1 << 8;                          // bit of EFLAGS: a SIGTRAP after the next instruction

std::array<std::atomic<const void*>, 4096> seen;
int log_file = -1;

/// Returns whether the address has not been seen before.
bool is_new(const void* at) {
  for (std::atomic<const void*>& entry : seen) {
    const void* held = nullptr;
    if (entry.compare_exchange_strong(held, at)) return true;
    if (held == at) return false;
  }
  return false;
}

void note(const void* at) {
  Dl_info module;
  if (!dladdr(at, &module) || !module.dli_fname) return;
  const char* slash = std::strrchr(module.dli_fname, '/');
  if (!std::strstr(slash ? slash : module.dli_fname, "frond") || !is_new(at)) return;
  std::array<char, 4096> line;
  const int size = std::snprintf(line.data(), line.size(), "%s %jx\n", module.dli_fname,
                                 uintmax_t(static_cast<const char*>(at) - static_cast<const char*>(module.dli_fbase)));
  if (write(log_file, line.data(), size_t(size)) != size) std::abort();
}

/// Carries out the instruction again without the trap; on_step then sets it again.
void on_invalid(int number, siginfo_t* info, void* context) {
  if (info->si_code != FPE_FLTINV) {
    std::signal(number, SIG_DFL);
    return;
  }
  note(info->si_addr);
  ucontext_t& state = *static_cast<ucontext_t*>(context);
  state.uc_mcontext.fpregs->mxcsr |= kInvalidMask;
  state.uc_mcontext.gregs[REG_EFL] |= kTrapFlag;
}

void on_step(int, siginfo_t*, void* context) {
  ucontext_t& state = *static_cast<ucontext_t*>(context);
  state.uc_mcontext.gregs[REG_EFL] &= ~kTrapFlag;
  state.uc_mcontext.fpregs->mxcsr &= ~(kInvalidFlag | kInvalidMask);
}

void handle(int number, void (*function)(int, siginfo_t*, void*)) {
  struct sigaction action {};
  action.sa_flags = SA_SIGINFO;
  action.sa_sigaction = function;
  sigaction(number, &action, nullptr);
}

[[gnu::constructor]] void start() {
  const char* path = std::getenv("FROND_TRAPS_LOG");
  if (!path) return;
  log_file = open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  handle(SIGFPE, on_invalid);
  handle(SIGTRAP, on_step);
  feenableexcept(FE_INVALID);  // new threads have it from the one that starts them
}

}  // namespace
