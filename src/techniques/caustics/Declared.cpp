#include "technique/Technique.h"
#include "techniques/caustics/Caustics.h"

namespace lucent::caustics {

namespace {
constexpr std::string_view kModel[] = {"environmentDirections"};
} // namespace

extern const technique::Declared kDeclared;
const technique::Declared kDeclared{
    .name = "caustics",
    .params = [] { return &Caustics::params(); },
    .model = kModel,
    .describe =
        [](const lucent::Settings& settings, truth::Model& model) {
            model.environmentCaustics = settings.as<Settings>().directions > 0;
        },
};

} // namespace lucent::caustics
