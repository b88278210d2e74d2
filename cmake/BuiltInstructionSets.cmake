# CHICANE_SIMD: which instruction sets this build has. All of the processor family, as a package should; `native`: the best one that the
# machine which builds has, the shortest build, good for this machine (run.sh); `runnable`: all that it has, what its tests can try
# (test.sh); or a list of names, `native` among them.
# In a `runnable` build Baseline beside a better one is built quickly, a quarter of the compiler's time: the same bits, but slower. The
# others keep forced inlining: a function left over would be code that the linker could take for Baseline's.
# CHICANE_INSTRUCTION_SETS (InstructionSets.cmake) is reduced to these, and chicane_base tells all that include it what is missing.
set(CHICANE_SIMD all CACHE STRING "Instruction sets to build: all, native, runnable, or a list such as baseline;avx2")

# Those of the family that the machine which builds has, the best one last.
function(chicane_runnable_instruction_sets result)
  set(runnable Baseline)
  foreach(set IN LISTS CHICANE_INSTRUCTION_SETS)
    string(TOLOWER ${set} name)
    try_run(CHICANE_HAS_${name} compiled ${CMAKE_CURRENT_BINARY_DIR}/native ${PROJECT_SOURCE_DIR}/cmake/has_instruction_set.c
            COMPILE_DEFINITIONS -DHAS_${name})
    if(CHICANE_HAS_${name} EQUAL 0)
      list(APPEND runnable ${set})
    endif()
  endforeach()
  list(REMOVE_DUPLICATES runnable)
  set(${result} ${runnable} PARENT_SCOPE)
endfunction()

function(chicane_native_instruction_sets result)
  chicane_runnable_instruction_sets(runnable)
  list(POP_BACK runnable best)
  set(${result} ${best} PARENT_SCOPE)
endfunction()

if(CHICANE_SIMD STREQUAL "all")
  return()
endif()
if(CHICANE_BUILD_TESTS AND NOT CHICANE_SIMD STREQUAL "runnable")
  message(FATAL_ERROR "CHICANE_SIMD: got ${CHICANE_SIMD}, expected all or runnable, which the tests cover; or configure with "
                      "-DCHICANE_BUILD_TESTS=OFF")
endif()
set(wanted "")
foreach(name IN LISTS CHICANE_SIMD)
  if(name MATCHES "^(native|runnable)$")
    cmake_language(CALL chicane_${name}_instruction_sets sets)
    list(APPEND wanted ${sets})
  else()
    string(SUBSTRING ${name} 0 1 first)
    string(SUBSTRING ${name} 1 -1 others)
    string(TOUPPER ${first} first)
    if(NOT "${first}${others}" IN_LIST CHICANE_INSTRUCTION_SETS)
      string(TOLOWER "${CHICANE_INSTRUCTION_SETS}" known)
      list(JOIN known ", " known)
      message(FATAL_ERROR "CHICANE_SIMD: got ${name}, expected all, native, runnable or some of ${known}")
    endif()
    list(APPEND wanted ${first}${others})
  endif()
endforeach()
set(CHICANE_LEFT_OUT ${CHICANE_INSTRUCTION_SETS})
list(REMOVE_ITEM CHICANE_LEFT_OUT ${wanted})
list(REMOVE_ITEM CHICANE_INSTRUCTION_SETS ${CHICANE_LEFT_OUT})
if(CHICANE_SIMD STREQUAL "runnable" AND NOT CHICANE_INSTRUCTION_SETS STREQUAL "Baseline")
  set(CHICANE_QUICKLY_BUILT_SETS Baseline)
endif()
list(JOIN CHICANE_INSTRUCTION_SETS ", " names)
string(TOLOWER "${names}" names)
message(STATUS "Instruction sets: ${names} alone, by CHICANE_SIMD=${CHICANE_SIMD}")
