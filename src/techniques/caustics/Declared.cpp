#include "technique/Technique.h"
#include "techniques/caustics/Caustics.h"

namespace lucent::caustics {

extern const technique::Declared kDeclared;
const technique::Declared kDeclared{.name = "caustics", .params = [] { return &Caustics::params(); }};

} // namespace lucent::caustics
