#include "technique/Technique.h"
#include "techniques/brdf/Brdf.h"

namespace lucent::brdf {

extern const technique::Declared kDeclared;
const technique::Declared kDeclared{.name = "brdf", .params = [] { return &params(); }};

} // namespace lucent::brdf
