# Debian packages and a tarball that runs unpacked: cmake --build build/release --target package, or ./run.sh package. docs/packages.md
# says what they hold; tests/package and tools/check_package.sh check them.
#
# A package is a group of install components. `deb_NAME` adds to the component NAME what Debian has in a form of its own (compressed,
# elsewhere); `plain` is what only an installation without a package manager has. To add a package: one call of chicane_package() below.
get_property(programs GLOBAL PROPERTY CHICANE_PROGRAMS)
set(CHICANE_PACKAGE_MAINTAINER "The chicane authors <authors@chicane.invalid>" CACHE STRING "Who answers for the packages: NAME <ADDRESS>")
set(CHICANE_PACKAGE_REVISION 1 CACHE STRING "Number of the packaging of one version, behind the dash of the package's version")
set(debian_dir ${PROJECT_SOURCE_DIR}/cmake/debian)
set(package_dir ${PROJECT_BINARY_DIR}/package)
set(deb_version ${PROJECT_VERSION}-${CHICANE_PACKAGE_REVISION})

# What `cpack` needs built, without tests and examples.
add_custom_target(chicane_installed)
add_dependencies(chicane_installed ${modules} ${programs})
if(TARGET chicane_python)
  add_dependencies(chicane_installed chicane_python)
endif()

set(CPACK_PACKAGE_NAME chicane)
set(CPACK_PACKAGE_VENDOR "The chicane authors")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_OUTPUT_FILE_PREFIX ${PROJECT_BINARY_DIR}/packages)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PROJECT_CONFIG_FILE ${PROJECT_SOURCE_DIR}/cmake/PackageOf.cmake)  # what differs between the generators
set(CPACK_CHICANE_SIMD ${CHICANE_SIMD})
set(CPACK_GENERATOR DEB)
if(TARGET chicane_app)
  list(APPEND CPACK_GENERATOR TZST)
endif()
set(CPACK_CHICANE_TARBALL_COMPONENTS program plain ros libraries)
set(CPACK_CHICANE_TARBALL chicane-${PROJECT_VERSION}-linux-${CMAKE_SYSTEM_PROCESSOR})

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${CHICANE_PACKAGE_MAINTAINER})
set(CPACK_DEBIAN_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_DEBIAN_PACKAGE_RELEASE ${CHICANE_PACKAGE_REVISION})
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS OFF)
if(CMAKE_CROSSCOMPILING)
  string(REGEX REPLACE "-.*" "" deb_architecture ${CMAKE_LIBRARY_ARCHITECTURE})
  string(REPLACE aarch64 arm64 CPACK_DEBIAN_PACKAGE_ARCHITECTURE ${deb_architecture})
endif()

# Runs when a package is made, not in `cmake --install`: writes FILE of package_dir/NAME by the shell command ARGN.
function(package_file name file folder)
  install(CODE "file(MAKE_DIRECTORY ${package_dir}/${name})
                execute_process(COMMAND sh -c [==[${ARGN}]==] OUTPUT_FILE ${package_dir}/${name}/${file} COMMAND_ERROR_IS_FATAL ANY)"
          COMPONENT deb_${name} EXCLUDE_FROM_ALL)
  install(FILES ${package_dir}/${name}/${file} DESTINATION ${folder} COMPONENT deb_${name} EXCLUDE_FROM_ALL)
endfunction()

# chicane_package(NAME COMPONENTS one two SECTION science SUMMARY "..." TEXT "..." [OF target...] [ARCH all] [SHLIBDEPS]
#                 [DEPENDS "a, b"] [CONFLICTS ...] [SUGGESTS ...] [SCRIPTS postinst prerm])
# No package where a target is missing that it is OF. TEXT has lines of at most 79 characters; a line with nothing but a dot begins a
# paragraph.
function(chicane_package name)
  cmake_parse_arguments(P "SHLIBDEPS" "SECTION;SUMMARY;TEXT;ARCH;DEPENDS;CONFLICTS;SUGGESTS" "OF;COMPONENTS;SCRIPTS" ${ARGN})
  foreach(target IN LISTS P_OF)
    if(NOT TARGET ${target})
      return()
    endif()
  endforeach()
  foreach(component IN LISTS P_COMPONENTS ITEMS deb_${name})
    string(TOUPPER ${component} upper)
    set(CPACK_COMPONENT_${upper}_GROUP ${name} PARENT_SCOPE)
    list(APPEND CPACK_CHICANE_DEB_COMPONENTS ${component})
  endforeach()
  set(CPACK_CHICANE_DEB_COMPONENTS ${CPACK_CHICANE_DEB_COMPONENTS} PARENT_SCOPE)
  string(TOUPPER ${name} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${P_SECTION} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${P_SUMMARY}\n${P_TEXT}" PARENT_SCOPE)
  foreach(field DEPENDS CONFLICTS SUGGESTS)
    set(CPACK_DEBIAN_${upper}_PACKAGE_${field} "${P_${field}}" PARENT_SCOPE)
  endforeach()
  list(TRANSFORM P_SCRIPTS PREPEND ${debian_dir}/${name}/)
  set(CPACK_DEBIAN_${upper}_PACKAGE_CONTROL_EXTRA "${P_SCRIPTS}" PARENT_SCOPE)
  if(P_SHLIBDEPS)
    set(CPACK_DEBIAN_${upper}_PACKAGE_SHLIBDEPS ON PARENT_SCOPE)
  endif()
  if(P_ARCH)
    set(CPACK_DEBIAN_${upper}_PACKAGE_ARCHITECTURE ${P_ARCH} PARENT_SCOPE)
  endif()

  set(doc share/doc/${name})
  install(FILES ${debian_dir}/copyright DESTINATION ${doc} COMPONENT deb_${name} EXCLUDE_FROM_ALL)
  package_file(${name} changelog.gz ${doc} "gzip -9nc ${PROJECT_SOURCE_DIR}/CHANGELOG.md")
  package_file(${name} changelog.Debian.gz ${doc}
               "${debian_dir}/changelog.sh ${deb_version} '${CHICANE_PACKAGE_MAINTAINER}' | gzip -9nc")
  file(CONFIGURE OUTPUT ${package_dir}/${name}/lintian-overrides CONTENT
    "# These packages are not uploaded to Debian, and close no bug of it.\n${name}: initial-upload-closes-no-bugs *\n")
  install(FILES ${package_dir}/${name}/lintian-overrides DESTINATION share/lintian/overrides RENAME ${name}
          COMPONENT deb_${name} EXCLUDE_FROM_ALL)
endfunction()

# The Debian packages that programs need which link the archives.
set(dev_depends "")
foreach(module IN LISTS modules)
  foreach(need IN LISTS needs_of_${module})
    list(APPEND dev_depends ${deb_of_${need}})
  endforeach()
endforeach()
list(REMOVE_DUPLICATES dev_depends)
if(TARGET chicane_app)
  list(APPEND dev_depends "chicane (= ${deb_version})")  # the data
endif()
list(JOIN dev_depends ", " dev_depends)

# The module is for one version of Python.
if(TARGET chicane_python)
  execute_process(COMMAND ${CHICANE_PYTHON_EXECUTABLE} -c "import sys; a, b = sys.version_info[:2]; print(f'{a}.{b};{a}.{b + 1}', end='')"
                  OUTPUT_VARIABLE python_versions COMMAND_ERROR_IS_FATAL ANY)
  list(GET python_versions 0 python_version)
  list(GET python_versions 1 python_next)
  set(python_folder lib/python3/dist-packages/chicane)
  install(DIRECTORY python/chicane/ DESTINATION ${python_folder} COMPONENT python EXCLUDE_FROM_ALL
          FILES_MATCHING PATTERN "*.py" PATTERN "*.pyi" PATTERN py.typed PATTERN __pycache__ EXCLUDE)
  install(TARGETS chicane_python LIBRARY DESTINATION ${python_folder} COMPONENT python EXCLUDE_FROM_ALL)
endif()

chicane_package(chicane OF chicane_app COMPONENTS program SECTION science SHLIBDEPS SUGGESTS "chicane-doc, chicane-ros, libchicane-dev, python3-chicane"
  SUMMARY "drives a car round a track by model predictive control"
  TEXT "Controller, simulator, recorder and dashboard in one program, with cars, tracks
and presets. A guard keeps a verified stop at hand.
.
The program serves its dashboard to a browser, drives external simulators by
WebSocket, compares controllers, and finds the limit of a car.")
chicane_package(chicane-ros OF chicane_app chicane_ros COMPONENTS ros SECTION science SHLIBDEPS DEPENDS "chicane (= ${deb_version})" SUGGESTS chicane-doc
  SUMMARY "model predictive control of cars - ROS 2 node without ROS"
  TEXT "The command chicane ros: the controller as a ROS 2 node, or the simulator for
one, by DDS alone. It needs no ROS installation.")
chicane_package(python3-chicane OF chicane_app chicane_python COMPONENTS python SECTION python SHLIBDEPS SCRIPTS postinst prerm
  DEPENDS "chicane (= ${deb_version}), python3 (>= ${python_version}~), python3 (<< ${python_next}~), python3-numpy" SUGGESTS chicane-doc
  SUMMARY "model predictive control of cars - Python module"
  TEXT "The module chicane: drives and measures cars, reads recordings, runs sweeps,
controllers and environments for learning written in Python, and optimal
control problems.")
chicane_package(libchicane-dev OF chicane_protocol COMPONENTS dev SECTION libdevel DEPENDS "${dev_depends}" CONFLICTS libchicane-solver-dev
  SUGGESTS chicane-doc
  SUMMARY "model predictive control of cars - C++ library"
  TEXT "Headers, archives, CMake package and pkg-config files of the modules that the
program chicane consists of: solver for optimal control problems, models and
plants of cars, controllers, guard, recording.")
if(CHICANE_SOLVER_ONLY)
  chicane_package(libchicane-solver-dev COMPONENTS dev SECTION libdevel DEPENDS "${dev_depends}" CONFLICTS libchicane-dev
    SUMMARY "solver for optimal control problems - C++ library"
    TEXT "Headers, archives, CMake package and pkg-config files of the solver of chicane
and what it stands on. It allocates no memory while it solves, and keeps
deadlines.")
endif()
chicane_package(chicane-doc OF chicane_protocol COMPONENTS doc SECTION doc ARCH all
  SUMMARY "model predictive control of cars - documentation and examples"
  TEXT "Tutorials, reference and explanations of the program chicane and its library as
Markdown pages, and example programs in C++ and Python.")

# The docs are part of no installation but the package's.
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT deb_chicane-doc EXCLUDE_FROM_ALL)
if(TARGET chicane_app)
  set(program_file $<TARGET_FILE:chicane_app>)
  package_file(chicane chicane.1.gz ${CMAKE_INSTALL_MANDIR}/man1 "${program_file} manual | gzip -9nc")
  package_file(chicane _chicane share/zsh/vendor-completions "${program_file} completion zsh")
  install(FILES ${debian_dir}/chicane.desktop DESTINATION share/applications COMPONENT deb_chicane EXCLUDE_FROM_ALL)
  install(FILES web/public/favicon.svg DESTINATION share/icons/hicolor/scalable/apps RENAME chicane.svg COMPONENT deb_chicane
          EXCLUDE_FROM_ALL)
  install(FILES ${debian_dir}/chicane-serve@.service DESTINATION lib/systemd/system COMPONENT deb_chicane EXCLUDE_FROM_ALL)
  install(FILES ${debian_dir}/chicane-ros@.service DESTINATION lib/systemd/system COMPONENT deb_chicane-ros EXCLUDE_FROM_ALL)

  # The tarball brings along the libraries that not every system has; the C library is the system's.
  set(private_libraries lib/chicane)
  set(up ..)
  foreach(program IN LISTS programs)
    set_target_properties(${program} PROPERTIES INSTALL_RPATH "$ORIGIN/${up}/${private_libraries}")
    target_link_options(${program} PRIVATE -Wl,--disable-new-dtags)  # an RPATH, which holds for the libraries of libraries, too
    list(APPEND program_files $<TARGET_FILE:${program}>)
    set(up ../..)  # all but the first one are in libexec/chicane
  endforeach()
  # Debian's libddsc has a path of its own, which keeps the loader from ours for what it needs: the program names it, too.
  if(TARGET chicane_ros)
    foreach(library IN ITEMS ssl iceoryx_binding_c)
      find_library(CHICANE_${library}_OF_DDSC ${library})
      mark_as_advanced(CHICANE_${library}_OF_DDSC)
      if(CHICANE_${library}_OF_DDSC)
        target_link_options(chicane_ros_app PRIVATE "LINKER:--push-state,--no-as-needed,-l${library},--pop-state")
      endif()
    endforeach()
  endif()
  install(CODE "file(GET_RUNTIME_DEPENDENCIES EXECUTABLES ${program_files} RESOLVED_DEPENDENCIES_VAR libraries
                     POST_EXCLUDE_REGEXES [[/(ld-linux.*|lib(c|m))[.]so]])
                file(INSTALL \${libraries} DESTINATION \${CMAKE_INSTALL_PREFIX}/${private_libraries} FOLLOW_SYMLINK_CHAIN)"
          COMPONENT libraries EXCLUDE_FROM_ALL)
endif()
include(CPack)
