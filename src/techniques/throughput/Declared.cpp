#include "technique/Technique.h"
#include "techniques/throughput/Throughput.h"

namespace lucent::throughput {

namespace {

constexpr std::string_view kLocals[] = {"live", "stored"};
constexpr std::string_view kGlobals[] = {"dense", "sparse", "hierarchical"};
constexpr std::string_view kBlends[] = {"fitted", "none"};
constexpr std::string_view kFresnels[] = {"exact", "schlick"};
constexpr std::string_view kParts[] = {"whole", "local", "global", "illumination"};

} // namespace

const ParamTable& params() {
    static const Param list[] = {
        declare(&Settings::local,
                {.id = "method",
                 .label = "Method",
                 .group = Group::Subsurface,
                 .doc = "What light leaves close to where it enters: computed where it is needed; or by 49 "
                        "factors stored for each texel, as in the paper.",
                 .choices = kLocals}),
        declare(&Settings::global,
                {.id = "global",
                 .label = "Far light",
                 .group = Group::Subsurface,
                 .doc =
                     "What vertices leave at each other: by all factors; by those above a threshold, as in "
                     "the paper; or by few products for many far vertices together.",
                 .choices = kGlobals}),
        declare(&Settings::blend,
                {.id = "blend",
                 .label = "Blending",
                 .group = Group::Subsurface,
                 .doc = "Of stored factors: fitted, so that close light counts once; none shows it counted "
                        "twice.",
                 .choices = kBlends}),
        declare(&Settings::side, {.id = "side",
                                  .label = "Texels a side",
                                  .min = 64,
                                  .max = 2048,
                                  .low = 128,
                                  .high = 1024,
                                  .logarithmic = true,
                                  .group = Group::Subsurface,
                                  .doc = "Of the atlas that light is gathered on."}),
        declare(&Settings::epsilon,
                {.id = "epsilon",
                 .label = "Error of far light",
                 .min = 1e-4,
                 .max = 0.5,
                 .low = 1e-3,
                 .high = 0.1,
                 .logarithmic = true,
                 .group = Group::Subsurface,
                 .doc =
                     "Bound on what products for many vertices leave out, over what leaves under even light "
                     "as bright as the brightest."}),
        declare(&Settings::threshold, {.id = "threshold",
                                       .label = "Least factor",
                                       .min = 0,
                                       .max = 1,
                                       .low = 1e-7,
                                       .high = 1e-3,
                                       .logarithmic = true,
                                       .group = Group::Subsurface,
                                       .doc = "Sparse factors below are left out."}),
        declare(&Settings::fresnel, {.id = "fresnel",
                                     .label = "Fresnel on entry",
                                     .group = Group::Subsurface,
                                     .doc = "Exact, or by Schlick's approximation, as in the paper.",
                                     .choices = kFresnels}),
        declare(&Settings::part, {.id = "part",
                                  .label = "Shown part",
                                  .group = Group::Subsurface,
                                  .doc = "All that leaves; of it what texels or what vertices carry; or the "
                                         "illumination map, the light that enters.",
                                  .choices = kParts}),
    };
    static const ParamTable table = tableOf<Settings>("throughput", list, "Precomputed throughput");
    return table;
}

BakeOptions optionsOf(const Settings& settings) {
    BakeOptions options{.side = settings.side, .local = settings.local, .blend = settings.blend};
    const FactorOptions usual;
    options.factors.method = settings.global;
    const bool isSparse = settings.global == Global::Sparse, isFew = settings.global == Global::Hierarchical;
    options.factors.threshold = isSparse ? settings.threshold : usual.threshold;
    options.factors.epsilon = isFew ? settings.epsilon : usual.epsilon;
    if (settings.local == Local::Live) options.blend = Blend::Fitted;
    return options;
}

bool acts(const Settings& settings, std::string_view id) {
    if (id == "blend") return settings.local == Local::Stored;
    if (id == "epsilon") return settings.global == Global::Hierarchical;
    if (id == "threshold") return settings.global == Global::Sparse;
    return true;
}

extern const technique::Declared kDeclared;
const technique::Declared kDeclared{.name = "throughput", .params = [] { return &params(); }};

} // namespace lucent::throughput
