#include "ReadTIFF.h"
namespace voxplex::io { bool IsTIFF(const InputFile&){return false;} ScalarImage ReadTIFF(const std::string&, Reading&){return {};} }
