#include "technique/Technique.h"
#include "techniques/relief/Relief.h"

namespace lucent::relief {

namespace {

constexpr std::string_view kModel[] = {"attenuation", "normalise"};

void describe(const lucent::Settings& all, truth::Model& model) {
    const auto& settings = all.as<Settings>();
    model.attenuation = settings.attenuation == Attenuation::Ratio ? truth::Attenuation::Ratio
                                                                   : truth::Attenuation::Exponential;
    model.normalise = settings.normalise;
}

} // namespace

extern const technique::Declared kDeclared;
const technique::Declared kDeclared{
    .name = "relief", .params = [] { return &Relief::params(); }, .model = kModel, .describe = describe};

} // namespace lucent::relief
