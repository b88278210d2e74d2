# What sources with a BatchSolver gain from: a stage of it is one block of 700 operations, which GCC by default schedules
# only after registers are given out. 12 % of a batch; nothing elsewhere.
set(CHICANE_BATCH_OPTIONS $<$<CXX_COMPILER_ID:GNU>:-fschedule-insns> $<$<CXX_COMPILER_ID:GNU>:-fsched-pressure>)

# chicane_simd_sources(controller fast_solver.cpp): compiles the file once for every instruction set of the processor
# family and adds the objects to the module (or the test of that name); how such a file is written is said in base/instruction_set.hpp. For each a
# test with label architecture proves that the object defines no code that other objects could share.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64|amd64")
  set(CHICANE_INSTRUCTION_SETS Baseline Avx2 Avx512)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64|ARM64")
  set(CHICANE_INSTRUCTION_SETS Baseline Neon)
else()
  set(CHICANE_INSTRUCTION_SETS Baseline)
endif()
set(CHICANE_FLAGS_Avx2 -mavx2 -mfma)
set(CHICANE_FLAGS_Avx512 -mavx2 -mfma -mavx512f -mavx512dq -mavx512vl -mprefer-vector-width=512)

# chicane_simd_options(TARGET Avx2): what compiling for an instruction set takes.
function(chicane_simd_options target set)
  target_compile_definitions(${target} PRIVATE CHICANE_ARCH=${set})
  target_compile_options(${target} PRIVATE ${CHICANE_FLAGS_${set}}
    $<$<CONFIG:Debug>:-O2>    # registers kept in memory would cost 50 times the time
    -Wno-psabi                # packs are never passed between objects
    $<$<CXX_COMPILER_ID:GNU>:-Wno-uninitialized -Wno-maybe-uninitialized>)  # GCC bug 105593, in its own intrinsics
endfunction()

function(chicane_simd_sources module)
  set(module_target chicane_${module})
  if(TARGET ${module})
    set(module_target ${module})
  endif()
  get_target_property(libraries ${module_target} LINK_LIBRARIES)
  foreach(source IN LISTS ARGN)
    get_filename_component(stem ${source} NAME_WE)
    foreach(set IN LISTS CHICANE_INSTRUCTION_SETS)
      string(TOLOWER ${set} suffix)
      set(object ${module_target}_${stem}_${suffix})
      add_library(${object} OBJECT ${source})
      set_target_properties(${object} PROPERTIES POSITION_INDEPENDENT_CODE ON)
      target_include_directories(${object} PRIVATE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/tests
                                 ${PROJECT_SOURCE_DIR}/bench)
      target_link_libraries(${object} PRIVATE chicane_options ${libraries})
      chicane_simd_options(${object} ${set})
      target_sources(${module_target} PRIVATE $<TARGET_OBJECTS:${object}>)
      if(CHICANE_BUILD_TESTS AND NOT set STREQUAL "Baseline")
        add_test(NAME architecture.symbols_${module}_${stem}_${suffix}
                 COMMAND python3 ${PROJECT_SOURCE_DIR}/tools/check_symbols.py arch::${set} $<TARGET_OBJECTS:${object}>)
        set_tests_properties(architecture.symbols_${module}_${stem}_${suffix} PROPERTIES LABELS architecture)
      endif()
    endforeach()
  endforeach()
endfunction()
