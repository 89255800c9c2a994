#include "ReadVTK.h"
namespace voxplex::io { bool IsVTK(const InputFile&){return false;} ScalarImage ReadVTK(const std::string&, Reading&){return {};} }
