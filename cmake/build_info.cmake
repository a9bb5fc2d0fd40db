# What `lockstep --version` tells: build type, versions of libraries as found, and the commit.
set(library_versions)
set(ZLIB_VERSION ${ZLIB_VERSION_STRING})
foreach(package embree OpenEXR OpenImageIO TBB glm fmt Boost CLI11 nlohmann_json pugixml kissfft
        tomlplusplus ZLIB)
  if(${package}_VERSION)
    list(APPEND library_versions "${package} ${${package}_VERSION}")
  endif()
endforeach()
list(JOIN library_versions ", " library_versions)
set_source_files_properties(commands/version_text.cpp PROPERTIES COMPILE_DEFINITIONS
  "LOCKSTEP_BUILD_TYPE=\"$<CONFIG>\";LOCKSTEP_LIBRARY_VERSIONS=\"${library_versions}\"")

# The commit is asked for at every build, and compiled, in a file of its own, when it has changed.
find_program(GIT_EXECUTABLE git)
set(commit_source ${CMAKE_CURRENT_BINARY_DIR}/commit.cpp)
add_custom_target(commit_source
  COMMAND ${CMAKE_COMMAND} -D GIT=${GIT_EXECUTABLE} -D SOURCE=${PROJECT_SOURCE_DIR}
          -D OUTPUT=${commit_source} -P ${CMAKE_CURRENT_LIST_DIR}/write_commit.cmake
  BYPRODUCTS ${commit_source} VERBATIM)
target_sources(lockstep_commands PRIVATE ${commit_source})
add_dependencies(lockstep_commands commit_source)
set_source_files_properties(${commit_source} commands/version_text.cpp PROPERTIES
                            SKIP_UNITY_BUILD_INCLUSION ON)
