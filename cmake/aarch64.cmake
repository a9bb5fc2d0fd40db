# Toolchain for 64-bit ARM from another machine: Debian's g++-aarch64-linux-gnu, and the libraries of
# packages.txt for arm64. These lie beside the machine's own, or, where LOCKSTEP_ARM64_ROOT in the
# environment names a folder, under it (docs/portability.md). What the build runs of its own, and
# tests, go through qemu-user where it is installed.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(arm64_root "$ENV{LOCKSTEP_ARM64_ROOT}")
if(arm64_root)
  set(CMAKE_SYSROOT "${arm64_root}")
endif()
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
find_program(LOCKSTEP_QEMU NAMES qemu-aarch64-static qemu-aarch64
             DOC "Runs programs for 64-bit ARM on this machine")
if(LOCKSTEP_QEMU)
  set(CMAKE_CROSSCOMPILING_EMULATOR "${LOCKSTEP_QEMU};-L;${arm64_root}/")
endif()
