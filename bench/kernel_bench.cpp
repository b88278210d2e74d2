// SPDX-License-Identifier: MIT
// What the passes over a quadratic program cost for each stage, for each instruction set of this processor:
// the described problem's pattern, and full ones; and what its functions cost.
#include <benchmark/benchmark.h>

#include <string>

#include "chicane/base/instruction_set.hpp"
#include "kernel_cases.hpp"

namespace {

using namespace chicane;
using bench::Kernel;
using bench::Part;
using bench::Shape;

template <class Run>
void per_stage(benchmark::State& state, InstructionSet set, const Run& run) {
  with_instructions(set, [&](auto arch) {
    for (auto _ : state) {
      run(arch);
      benchmark::ClobberMemory();
    }
  });
  state.counters["s/stage"] =
      benchmark::Counter(static_cast<double>(bench::kKernelStages),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void Pass(benchmark::State& state, InstructionSet set, Kernel kernel, Shape shape) {
  per_stage(state, set, [&](auto arch) { bench::run_kernel<decltype(arch)>(kernel, shape); });
}
void Functions(benchmark::State& state, InstructionSet set, Part part) {
  per_stage(state, set, [&](auto arch) { bench::run_part<decltype(arch)>(part); });
}

const struct {
  const char* name;
  Shape shape;
} kShapes[] = {{"described", Shape::kDescribed}, {"full4", Shape::kFull4},   {"full6", Shape::kFull6},
               {"full8", Shape::kFull8},         {"full10", Shape::kFull10}, {"full12", Shape::kFull12}};
const struct {
  const char* name;
  Kernel kernel;
} kKernels[] = {{"Backward", Kernel::kBackward}, {"Forward", Kernel::kForward}};

const struct {
  const char* name;
  Part part;
} kParts[] = {{"RollOut", Part::kRollOut},
              {"LineariseFirstOrder", Part::kFirstOrder},
              {"LineariseSecondOrder", Part::kSecondOrder},
              {"SetStages", Part::kSetStages}};

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  for (const auto set :
       {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512, InstructionSet::kNeon}) {
    if (!is_available(set)) continue;
    const std::string name(to_string(set));
    for (const auto& kernel : kKernels) {
      for (const auto& shape : kShapes) {
        benchmark::RegisterBenchmark(
            (std::string(kernel.name) + "/" + shape.name + "/" + name).c_str(),
            [=](benchmark::State& state) { Pass(state, set, kernel.kernel, shape.shape); });
      }
    }
    for (const auto& part : kParts) {
      benchmark::RegisterBenchmark((std::string(part.name) + "/described/" + name).c_str(),
                                   [=](benchmark::State& state) { Functions(state, set, part.part); });
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
