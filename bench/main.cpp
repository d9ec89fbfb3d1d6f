#include <benchmark/benchmark.h>

#include "system/machine.h"

namespace {

#ifdef __clang__
constexpr const char* kCompiler = __VERSION__;
#else
constexpr const char* kCompiler = "g++ " __VERSION__;
#endif

}  // namespace

/// Google Benchmark's main; adds frond's version, compiler, flags and machine to the context.
int main(int argc, char** argv) {
  benchmark::AddCustomContext("frond_version", FROND_VERSION);
  benchmark::AddCustomContext("compiler", kCompiler);
  benchmark::AddCustomContext("compiler_flags", FROND_BENCH_FLAGS);
  benchmark::AddCustomContext("machine", frond::machine_description());
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
