# cmake --install BUILD --prefix PREFIX: the program with what it loads and how shells complete it
# (component program), and headers, libraries and CMake package for programs that build on them
# (component library). Everything finds everything else by relative paths: the prefix may move.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(library_targets lockstep_options lockstep_core lockstep_samplers lockstep_packets lockstep_metrics
    lockstep_ranks lockstep_experiments lockstep_commands)
set(module_folder ${CMAKE_INSTALL_LIBDIR}/lockstep)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/lockstep)

# The program looks for the module of image formats where its rpath says.
file(RELATIVE_PATH module_from_program /${CMAKE_INSTALL_BINDIR} /${module_folder})
set_target_properties(lockstep PROPERTIES INSTALL_RPATH "$ORIGIN/${module_from_program}")
install(TARGETS lockstep RUNTIME COMPONENT program)
install(TARGETS lockstep_image_formats LIBRARY DESTINATION ${module_folder} COMPONENT program)
install(FILES experiments/poster.toml experiments/beyond.toml
        DESTINATION ${CMAKE_INSTALL_DATADIR}/lockstep/experiments COMPONENT program)
install(FILES README.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT program)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)

# The manual page and what shells complete by are printed by the program that is installed.
set(printed ${PROJECT_BINARY_DIR}/printed)
install(CODE "
  file(MAKE_DIRECTORY ${printed})
  set(printing $<TARGET_FILE:lockstep>)
  execute_process(COMMAND \${printing} manual OUTPUT_FILE ${printed}/lockstep.1
                  COMMAND_ERROR_IS_FATAL ANY)
  foreach(shell bash zsh fish)
    execute_process(COMMAND \${printing} completion \${shell} OUTPUT_FILE ${printed}/\${shell}
                    COMMAND_ERROR_IS_FATAL ANY)
  endforeach()
  file(ARCHIVE_CREATE OUTPUT ${printed}/lockstep.1.gz PATHS ${printed}/lockstep.1
       FORMAT raw COMPRESSION GZip)
" COMPONENT program)
set(share ${CMAKE_INSTALL_DATADIR})
install(FILES ${printed}/lockstep.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${printed}/bash DESTINATION ${share}/bash-completion/completions RENAME lockstep
        COMPONENT program)
install(FILES ${printed}/zsh DESTINATION ${share}/zsh/vendor-completions RENAME _lockstep
        COMPONENT program)
install(FILES ${printed}/fish DESTINATION ${share}/fish/vendor_completions.d RENAME lockstep.fish
        COMPONENT program)

# How this project compiles itself is not how others have to: warnings and the like stay here.
foreach(property COMPILE_OPTIONS INCLUDE_DIRECTORIES SYSTEM_INCLUDE_DIRECTORIES)
  get_target_property(values lockstep_options INTERFACE_${property})
  if(values)
    set_target_properties(lockstep_options PROPERTIES INTERFACE_${property}
                          "$<BUILD_INTERFACE:${values}>")
  endif()
endforeach()
# Samplers of others too must have the same bits at every packet width.
target_compile_options(lockstep_options INTERFACE $<INSTALL_INTERFACE:-ffp-contract=off>)
target_compile_features(lockstep_options INTERFACE cxx_std_20)
target_include_directories(lockstep_options INTERFACE
                           $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/lockstep>)
target_link_libraries(lockstep_options INTERFACE $<INSTALL_INTERFACE:glm::glm>)

foreach(target ${library_targets})
  string(REPLACE lockstep_ "" name ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
endforeach()
install(TARGETS ${library_targets} EXPORT lockstep ARCHIVE COMPONENT library)
foreach(folder core samplers packets experiments)
  install(DIRECTORY ${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lockstep COMPONENT library
          FILES_MATCHING PATTERN "*.h" PATTERN page EXCLUDE PATTERN tables EXCLUDE)
endforeach()
install(EXPORT lockstep NAMESPACE lockstep:: FILE lockstepTargets.cmake
        DESTINATION ${package_folder} COMPONENT library)
configure_package_config_file(cmake/lockstepConfig.cmake.in lockstepConfig.cmake
                              INSTALL_DESTINATION ${package_folder} PATH_VARS module_folder)
write_basic_package_version_file(lockstepConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lockstepConfig.cmake
        ${PROJECT_BINARY_DIR}/lockstepConfigVersion.cmake
        DESTINATION ${package_folder} COMPONENT library)
