#ifndef xTIFF
#define xTIFF
#include "ScalarImage.h"
#include <string>
namespace voxplex::io { class InputFile; struct Reading; bool IsTIFF(const InputFile&); ScalarImage ReadTIFF(const std::string&, Reading&); }
#endif
