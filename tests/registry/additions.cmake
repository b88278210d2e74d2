# What adding a plant, a fault and a track format takes: their own files, below added/, and here for each the one line in a
# list, with the header that it needs.
set(plant_list src/chicane/sim/plant_registry.cpp)
set(plant_header chicane/sim/cart.hpp)
set(plant_after "    kDoubleTrack,\n")
set(plant_line "    plant<Cart>(),\n")

set(fault_list src/chicane/sim/fault_registry.cpp)
set(fault_header chicane/sim/detail/fast_speedometer.hpp)
set(fault_after "    kCommandDropped,\n")
set(fault_line "    kFastSpeedometer,\n")

set(track_list src/chicane/protocol/track_codec.cpp)
set(track_header chicane/protocol/circle_track.hpp)
set(track_after "    kCsvTrack,\n")
set(track_line "    kCircleTrack,\n")

# with_addition(KIND FILE RESULT): the text of a list with the line and its include.
function(with_addition kind file result)
  file(READ ${file} text)
  string(REPLACE "${${kind}_after}" "${${kind}_after}${${kind}_line}" changed "${text}")
  if(changed STREQUAL text)
    message(FATAL_ERROR "${file}: expected in it: ${${kind}_after}")
  endif()
  string(FIND "${changed}" "#include \"chicane/" place)
  string(SUBSTRING "${changed}" 0 ${place} front)
  string(SUBSTRING "${changed}" ${place} -1 back)
  set(${result} "${front}#include \"${${kind}_header}\"\n${back}" PARENT_SCOPE)
endfunction()
