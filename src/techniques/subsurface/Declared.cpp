#include "technique/Technique.h"
#include "techniques/subsurface/Subsurface.h"

namespace lucent::subsurface {

namespace {

constexpr std::string_view kModel[] = {"profile", "dipoleGeometry", "exit"};
void describe(const lucent::Settings& all, truth::Model& model) {
    const auto& settings = all.as<Settings>();
    const bool offset = settings.dipoleGeometry == DipoleGeometry::Offset;
    model.dipole.profile = truth::Diffusion(int(settings.profile)); // in the same order
    model.dipole.geometry = offset ? truth::DipoleGeometry::Offset : truth::DipoleGeometry::Planar;
    model.dipole.normalisedExit = settings.exit == Exit::Whole;
    model.walks = settings.method == Method::Diffusion;
}

} // namespace

extern const technique::Declared kDeclared;
const technique::Declared kDeclared{.name = "subsurface",
                                    .params = [] { return &Subsurface::params(); },
                                    .model = kModel,
                                    .describe = describe};

} // namespace lucent::subsurface
