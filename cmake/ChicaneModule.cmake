# One folder of src/chicane is one static library chicane::<name> of all headers and sources in it and in its detail/. The libraries it may
# use are its arrows in tools/layers.txt.
#
#   chicane_module(road PRIVATE yaml-cpp)
#
# PRIVATE_HEADERS are for our own sources and not installed, HEADERS lie elsewhere. SIMD_SOURCES are compiled once for each instruction set
# (InstructionSets.cmake). A test has every *_test.cpp of its folder but those WITHOUT, and FURTHER sources; or its SOURCES alone. Each of its
# tests is a process of its own, but those of a suite in SUITES, which share what takes long to make. OWN_OPTIONS is for tests that are
# compiled with further options, and so cannot have the precompiled headers of the others; RUN_HEADERS for those that include the headers of
# runs or of JSON, which are precompiled for them, too.
#
# Most of a small source file's compile time goes into the headers that it includes. UNITY compiles the module's sources as one file,
# chicane_unity(TARGET GROUP FILE...) some of a target's, and a test BATCH of its sources at a time, without it all at once; so names in
# their anonymous namespaces must differ. Files that no group of a module names, such as a new controller's, are compiled alone.
# LIGHT is for what no control step waits for: -O1. Tests have -Og. docs/measured/program.md says what this is good for.
option(CHICANE_UNITY "Compile groups of sources as one file; OFF, as in the preset dev: each alone" ON)

function(chicane_unity target group)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${CHICANE_UNITY} UNITY_BUILD_MODE GROUP)
  set_source_files_properties(${ARGN} PROPERTIES UNITY_GROUP ${group})
endfunction()

function(chicane_light target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# What each module and each folder above the library may use: chicane_arrows_of_NAME.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tools/layers.txt)
file(STRINGS ${PROJECT_SOURCE_DIR}/tools/layers.txt layers REGEX "^[a-z_]+:")
foreach(layer IN LISTS layers)
  string(REGEX MATCHALL "[a-z_]+" words ${layer})
  list(POP_FRONT words name)
  set(chicane_arrows_of_${name} ${words})
endforeach()

function(chicane_module name)
  cmake_parse_arguments(M "UNITY;LIGHT" "" "HEADERS;SIMD_SOURCES;PRIVATE;PRIVATE_HEADERS" ${ARGN})
  file(GLOB headers CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} *.hpp detail/*.hpp)
  file(GLOB sources CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} *.cpp detail/*.cpp)
  list(REMOVE_ITEM headers ${M_PRIVATE_HEADERS})
  list(REMOVE_ITEM sources ${M_SIMD_SOURCES})
  set(target chicane_${name})
  list(TRANSFORM chicane_arrows_of_${name} PREPEND chicane_ OUTPUT_VARIABLE depends)
  if(sources)
    add_library(${target} STATIC ${sources})
    set(scope PUBLIC)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:chicane_options> ${M_PRIVATE})
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    if(name IN_LIST CHICANE_HARDENED_MODULES)
      target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:chicane_hardened>)
    endif()
    if(M_UNITY)
      chicane_unity(${target} ${name} ${sources})
    endif()
    if(M_LIGHT)
      chicane_light(${target})
    endif()
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(chicane::${name} ALIAS ${target})
  target_compile_features(${target} ${scope} cxx_std_20)
  target_link_libraries(${target} ${scope} ${depends} tl::expected)
  target_sources(${target} ${scope} FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/src FILES ${headers} ${M_HEADERS})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} OUTPUT_NAME chicane_${name})
  set_property(GLOBAL APPEND PROPERTY CHICANE_MODULES ${target})
  if(M_SIMD_SOURCES)
    chicane_simd_sources(${name} ${M_SIMD_SOURCES})
  endif()
endfunction()

# Every test runs below a script that notes its processor time for ./test.sh.
set(chicane_measured ${PROJECT_SOURCE_DIR}/tests/support/measured.sh)
if(NOT CMAKE_CROSSCOMPILING)
  function(add_test NAME name COMMAND program)
    if(TARGET ${program})
      set(program $<TARGET_FILE:${program}>)
    endif()
    set(words "")
    foreach(i RANGE 4 ${ARGC})  # one more than there are: the last is empty
      if(i LESS ARGC)
        string(APPEND words " [==[${ARGV${i}}]==]")
      endif()
    endforeach()
    cmake_language(EVAL CODE "_add_test(NAME ${name} COMMAND ${chicane_measured} ${name} [==[${program}]==] ${words})")
  endfunction()
endif()

# chicane_command_test(NAME "label;slow" SECONDS COMMAND word... [PROPERTIES name value...]): a test that is a command. It knows
# by CHICANE_SLOW_TESTS whether to try more, and is skipped where it ends with 77.
function(chicane_command_test name labels limit)
  cmake_parse_arguments(PARSE_ARGV 3 T "" "" "COMMAND;PROPERTIES")
  add_test(NAME ${name} COMMAND ${T_COMMAND})
  set_tests_properties(${name} PROPERTIES LABELS "${labels}" TIMEOUT ${limit} SKIP_RETURN_CODE 77 ${T_PROPERTIES})
  if(CHICANE_SLOW_TESTS)
    set_property(TEST ${name} APPEND PROPERTY ENVIRONMENT CHICANE_SLOW_TESTS=1)
  endif()
endfunction()

function(chicane_test_options target)
  # Without forced inlining, which would take the compiler minutes, GCC takes the empty second argument of a chain of jets for a value.
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-Og> $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_libraries(${target} PRIVATE chicane_options chicane_test_support)
  target_compile_definitions(${target} PRIVATE CHICANE_ENABLE_ASSERT CHICANE_NO_FORCED_INLINE CHICANE_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
    $<$<BOOL:${CHICANE_SLOW_TESTS}>:CHICANE_SLOW_TESTS>)
endfunction()

function(chicane_test name)
  cmake_parse_arguments(T "OWN_OPTIONS;RUN_HEADERS" "BATCH" "SOURCES;FURTHER;WITHOUT;DEPENDS;LABELS;PRIVATE;SUITES" ${ARGN})
  if(NOT T_DEPENDS)
    set(T_DEPENDS ${name})
  endif()
  if(NOT T_SOURCES)
    file(GLOB T_SOURCES CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} *_test.cpp)
    list(REMOVE_ITEM T_SOURCES ${T_WITHOUT})
  endif()
  list(TRANSFORM T_DEPENDS PREPEND chicane_)
  set(target ${name}_test)
  add_executable(${target} ${T_SOURCES} ${T_FURTHER})
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${CHICANE_UNITY} UNITY_BUILD_BATCH_SIZE "0${T_BATCH}")  # 0: all
  chicane_test_options(${target})
  target_link_libraries(${target} PRIVATE ${T_DEPENDS} ${T_PRIVATE})
  if(NOT CMAKE_CROSSCOMPILING)
    set_target_properties(${target} PROPERTIES CROSSCOMPILING_EMULATOR "${chicane_measured};-")
  endif()
  if(NOT T_OWN_OPTIONS)
    set(headers chicane_test_headers)
    if(T_RUN_HEADERS)
      set(headers chicane_run_test_headers)
    endif()
    target_precompile_headers(${target} REUSE_FROM ${headers})
  endif()
  # One label with all words in it, which `ctest -L` and `-LE` find: gtest_discover_tests takes lists apart.
  string(JOIN ":" labels ${name} ${T_LABELS})
  set(limit 300)
  if(CHICANE_SLOW_TESTS)
    set(limit 14400)
  endif()
  set(others ${T_SUITES})
  foreach(suite IN LISTS T_SUITES)
    add_test(NAME ${suite} COMMAND ${target} --gtest_filter=${suite}.*:*/${suite}.*)
    set_tests_properties(${suite} PROPERTIES LABELS "${labels}" TIMEOUT ${limit})
  endforeach()
  if(others)
    list(TRANSFORM others REPLACE "(.+)" "\\1.*:*/\\1.*")
    list(JOIN others ":" others)
    set(others TEST_FILTER "-${others}")
  endif()
  gtest_discover_tests(${target} DISCOVERY_TIMEOUT 60 DISCOVERY_MODE PRE_TEST ${others}
                       PROPERTIES LABELS "${labels}" TIMEOUT ${limit})
endfunction()
