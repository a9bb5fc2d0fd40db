# cpack -G DEB, in the build directory: two Debian packages, the program and what programs that build
# on it need. `cpack -G TGZ` makes archives of the same.
set(CPACK_PACKAGE_NAME lockstep)
set(CPACK_PACKAGE_VENDOR Lockstep)
set(CPACK_PACKAGE_CONTACT "The Lockstep authors <lockstep@localhost>" CACHE STRING
    "Maintainer that packages name")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_COMPONENTS_ALL program library)
set(CPACK_STRIP_FILES ON)
set(CPACK_GENERATOR DEB)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)  # by dpkg-shlibdeps, of the package dpkg-dev
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME lockstep)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "All pixels of a tile follow one shared random sequence, so neighbouring rays stay together and a SIMD
packet traces them in lockstep. The renderer measures what that buys in speed and what it costs or
saves in perceived error, in the same run, at equal time.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME liblockstep-dev)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "Static libraries, headers and the CMake package of Lockstep, for programs that add samplers or metrics
or that render by themselves.")
# What the CMake package looks for: the libraries of packages.txt, without tools, tests and images.
file(STRINGS packages.txt libraries REGEX "-dev$")
list(FILTER libraries EXCLUDE REGEX "^(libopenimageio|libtinygltf|libgtest|libbenchmark)")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS "lockstep (= ${PROJECT_VERSION}-1)" ${libraries})
list(JOIN CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS ", " CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SUGGESTS cmake)
include(CPack)
