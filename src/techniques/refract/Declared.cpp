#include "technique/Technique.h"
#include "techniques/refract/Refract.h"

namespace lucent::refract {

extern const technique::Declared kDeclared;
const technique::Declared kDeclared{.name = "refract", .params = [] { return &Refract::params(); }};

} // namespace lucent::refract
