# Slicer writes the extension's CMake package here. See SlicerConfig.cmake.
