#include "ReadDICOM.h"
namespace voxplex::io { bool IsDICOM(const InputFile&){return false;} ScalarImage ReadDICOMFile(const std::string&, Reading&){return {};} ScalarImage ReadDICOMFolder(const std::string&, const std::string&, Reading&){return {};}}
