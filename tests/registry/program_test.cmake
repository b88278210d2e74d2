# Copies the tree, adds one of each kind (additions.cmake), builds the program and asks it: what it lists, takes, refuses and drives.
# Arguments: SOURCE, COPY, COMPILER, LAUNCHER.
include(${CMAKE_CURRENT_LIST_DIR}/additions.cmake)

function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${COPY} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(code)
    message(FATAL_ERROR "${ARGN}: exit code ${code}\n${out}")
  endif()
endfunction()

# chicane_says(CODE TEXT WORD...): the program ends with that code and prints the text.
function(chicane_says expected text)
  execute_process(COMMAND build/apps/chicane/chicane ${ARGN} WORKING_DIRECTORY ${COPY}
                  RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
  string(FIND "${out}" "${text}" place)
  if(NOT code EQUAL expected OR place EQUAL -1)
    message(FATAL_ERROR "chicane ${ARGN}: exit code ${code}, expected ${expected} and \"${text}\" in\n${out}")
  endif()
endfunction()

foreach(part CMakeLists.txt LICENSE apps bench cmake data src tools web)
  file(COPY ${SOURCE}/${part} DESTINATION ${COPY} PATTERN node_modules EXCLUDE)
endforeach()
file(COPY ${CMAKE_CURRENT_LIST_DIR}/added/ DESTINATION ${COPY})
foreach(kind ${additions})
  with_addition(${kind} ${SOURCE}/${${kind}_list} text)
  file(WRITE ${COPY}/${${kind}_list} "${text}")
endforeach()
run(${CMAKE_COMMAND} -G Ninja -S . -B build -DCMAKE_BUILD_TYPE=Release -DCHICANE_BUILD_TESTS=OFF -DCHICANE_BUILD_EXAMPLES=OFF
    -DCHICANE_WEB=OFF -DCHICANE_SIMD=native -DCMAKE_CXX_COMPILER=${COMPILER} "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}")
run(${CMAKE_COMMAND} --build build --target chicane_app)

chicane_says(0 "hold-steady        holds wheel and pedal" list controllers)
chicane_says(0 "cart               rolls where its wheels point" list plants)
chicane_says(0 "fast_speedometer" list faults)
chicane_says(0 "hold_steady.throttle" list parameters)
chicane_says(0 "| `hold_steady.steer_deg` | 0 | deg | -20 … 20 | Where the wheel is held. |" list parameters --markdown)
chicane_says(0 "steady             Holds wheel and pedal" list presets)

file(WRITE ${COPY}/data/tracks/ring.circle "80\n")
chicane_says(0 "ring" list tracks)
chicane_says(0 "ring.circle: ok, closed track, 502.7 m long" check data/tracks/ring.circle)
chicane_says(0 "data/presets/steady.yaml: ok" check data/presets/steady.yaml)
file(WRITE ${COPY}/data/tracks/small.circle "3\n")
chicane_says(2 "small.circle:1: radius: got 3" check data/tracks/small.circle)

chicane_says(1 "hold-steady" drive --fast --preset steady --set plant=cart --track ring --fault fast_speedometer@1+2*2
             --laps 1 --set time_limit_s=5 --json)
chicane_says(2 "hold_steady.throttle: got 2, expected a number in [0, 1]" drive --fast --preset steady
             --set hold_steady.throttle=2)
chicane_says(2 "--speed-mps: got 10, expected none: hold-steady has no speed to set" drive --fast --preset steady
             --speed-mps 10)
