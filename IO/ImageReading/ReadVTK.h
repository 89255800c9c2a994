#ifndef xVTK
#define xVTK
#include "ScalarImage.h"
#include <string>
namespace voxplex::io { class InputFile; struct Reading; bool IsVTK(const InputFile&); ScalarImage ReadVTK(const std::string&, Reading&); }
#endif
