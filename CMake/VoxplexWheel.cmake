# What the wheel (pyproject.toml) has beside the program: a package that starts it. The prefix is the package's folder.

set(_voxplex_program "${CMAKE_INSTALL_BINDIR}/voxplex") # seen from there
set(_voxplex_installation "${CMAKE_BINARY_DIR}/wheel/installation.py")
configure_file(Python/voxplex/installation.py.in "${_voxplex_installation}" @ONLY)
install(
  FILES
    Python/wheel/__init__.py
    Python/voxplex/__main__.py
    "${_voxplex_installation}"
  DESTINATION .
  COMPONENT   wheel)
