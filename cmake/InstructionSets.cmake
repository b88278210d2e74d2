# chicane_simd_sources(TARGET FILE... [CHECK_SYMBOLS])
#
# Compiles each file once for every instruction set of CHICANE_INSTRUCTION_SETS and adds the objects to the target, as if they were its
# own sources: with its libraries (so call it after target_link_libraries()), include folders and options. The program chooses when it
# runs; how such a file is written is said in chicane/base/instruction_set.hpp. The files belong in no other list of sources.
#
#   find_package(chicane REQUIRED COMPONENTS solver)
#   add_executable(my_program main.cpp)
#   target_link_libraries(my_program PRIVATE chicane::solver)
#   chicane_simd_sources(my_program my_solver.cpp)
#
# CHECK_SYMBOLS adds a test for each file and instruction set (needs python3 and nm): its object defines no code that the linker could
# take for another's. In chicane's own build, where a target may leave out its `chicane_`, that is always so.

if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64|amd64")
  set(CHICANE_INSTRUCTION_SETS Baseline Avx2 Avx512)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64|ARM64")
  set(CHICANE_INSTRUCTION_SETS Baseline Neon)
else()
  set(CHICANE_INSTRUCTION_SETS Baseline)
endif()
set(CHICANE_FLAGS_Avx2 -mavx2 -mfma)
set(CHICANE_FLAGS_Avx512 -mavx2 -mfma -mavx512f -mavx512dq -mavx512vl -mprefer-vector-width=512)
set(CHICANE_FLAGS_FLOAT -ffp-contract=off -fno-math-errno)  # same bits from every compiler and build type

find_file(CHICANE_CHECK_SYMBOLS check_symbols.py NO_DEFAULT_PATH NO_CACHE
          PATHS ${CMAKE_CURRENT_LIST_DIR} ${CMAKE_CURRENT_LIST_DIR}/../tools)

# chicane_simd_options(TARGET Avx2): what compiling for an instruction set takes.
function(chicane_simd_options target set)
  target_compile_definitions(${target} PRIVATE CHICANE_ARCH=${set})
  target_compile_options(${target} PRIVATE ${CHICANE_FLAGS_${set}}
    $<$<CONFIG:Debug>:-O2>    # registers kept in memory would cost 50 times the time
    $<$<CXX_COMPILER_ID:GNU>:-fno-gcse-after-reload>  # a sixth of the compile time of large solvers, for nothing measurable
    -Wno-psabi                # packs are never passed between objects
    $<$<CXX_COMPILER_ID:GNU>:-Wno-uninitialized -Wno-maybe-uninitialized>)  # GCC bug 105593, in its own intrinsics
endfunction()

function(chicane_simd_sources name)
  cmake_parse_arguments(S "CHECK_SYMBOLS" "" "" ${ARGN})
  set(target chicane_${name})
  if(TARGET ${name})
    set(target ${name})
  endif()
  get_target_property(libraries ${target} LINK_LIBRARIES)
  if(NOT libraries)
    set(libraries "")
  endif()
  get_target_property(is_left_out ${target} EXCLUDE_FROM_ALL)
  foreach(source IN LISTS S_UNPARSED_ARGUMENTS)
    get_filename_component(stem ${source} NAME_WE)
    foreach(set IN LISTS CHICANE_INSTRUCTION_SETS)
      string(TOLOWER ${set} suffix)
      set(object ${target}_${stem}_${suffix})
      add_library(${object} OBJECT ${source})
      set_target_properties(${object} PROPERTIES POSITION_INDEPENDENT_CODE ON EXCLUDE_FROM_ALL ${is_left_out})
      target_link_libraries(${object} PRIVATE ${libraries})
      target_include_directories(${object} PRIVATE $<TARGET_PROPERTY:${target},INCLUDE_DIRECTORIES>)
      if(TARGET chicane_options)
        target_link_libraries(${object} PRIVATE chicane_options)
      else()
        target_compile_definitions(${object} PRIVATE $<TARGET_PROPERTY:${target},COMPILE_DEFINITIONS>)
        target_compile_options(${object} PRIVATE $<TARGET_PROPERTY:${target},COMPILE_OPTIONS> ${CHICANE_FLAGS_FLOAT})
        target_compile_features(${object} PRIVATE cxx_std_20)
      endif()
      chicane_simd_options(${object} ${set})
      target_sources(${target} PRIVATE $<TARGET_OBJECTS:${object}>)
      if((S_CHECK_SYMBOLS OR CHICANE_BUILD_TESTS) AND NOT is_left_out AND NOT set STREQUAL "Baseline")
        add_test(NAME architecture.symbols_${name}_${stem}_${suffix}
                 COMMAND python3 ${CHICANE_CHECK_SYMBOLS} arch::${set} $<TARGET_OBJECTS:${object}>)
        set_tests_properties(architecture.symbols_${name}_${stem}_${suffix} PROPERTIES LABELS architecture)
      endif()
    endforeach()
  endforeach()
endfunction()
