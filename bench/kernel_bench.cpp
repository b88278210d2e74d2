// SPDX-License-Identifier: MIT
// Time of the passes over a quadratic program and of the problem's functions for each stage, for each
// instruction set of this processor.
#include "kernel_cases.hpp"

#include <benchmark/benchmark.h>

#include <string>

#include "chicane/base/instruction_set.hpp"

namespace {

using namespace chicane;

void per_stage(benchmark::State& state, void (*run)() noexcept) {
  for (auto _ : state) {
    run();
    benchmark::ClobberMemory();
  }
  state.counters["s/stage"] =
      benchmark::Counter(static_cast<double>(bench::kKernelStages),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  for (const auto set :
       {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512, InstructionSet::kNeon}) {
    if (!is_available(set)) continue;
    const auto cases =
        with_instructions(set, [](auto arch) { return bench::kernel_cases<decltype(arch)>(); });
    for (const bench::KernelCase& one : cases)
      benchmark::RegisterBenchmark((std::string(one.name) + "/" + std::string(to_string(set))).c_str(),
                                   per_stage, one.run);
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
