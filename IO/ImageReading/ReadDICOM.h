#ifndef xD
#define xD
#include "ScalarImage.h"
#include <string>
namespace voxplex::io { class InputFile; struct Reading; bool IsDICOM(const InputFile&); ScalarImage ReadDICOMFile(const std::string&, Reading&);  ScalarImage ReadDICOMFolder(const std::string&, const std::string&, Reading&); }
#endif
