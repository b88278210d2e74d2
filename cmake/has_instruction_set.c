/* Ends with 0 where this machine has the instruction set of the definition: as is_supported() in base/instruction_set.cpp. */
int main(void) {
#if defined(HAS_avx2)
  return !(__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"));
#elif defined(HAS_avx512)
  return !(__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("avx512f") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"));
#else
  return 0; /* the whole family has it */
#endif
}
