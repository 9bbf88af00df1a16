#include "base/Text.h"
#include "scene/Canvas.h"
#include "scene/Mesh.h"
#include "scene/readers/Readers.h"
#include "tests/scene/Files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace lucent::scene {
namespace {

Object ball(float radius = 0.5f) {
    Object object;
    object.name = "ball";
    MeshShape shape;
    shape.mesh = std::make_shared<const Mesh>(meshOf(Sphere{radius}, 64));
    object.shape = shape;
    object.material.kind = Translucent{};
    return object;
}

std::shared_ptr<const PaintSurface> surfaceOf(const Object& object, int side) {
    const auto surface = paintSurfaceOf(object, side);
    EXPECT_TRUE(surface) << surface.error().message;
    return *surface;
}

Canvas canvasOn(const Object& object, int side, std::size_t budget = Canvas::kBudget) {
    return Canvas(surfaceOf(object, side), object.transform.scale, nullptr, nullptr, budget);
}

// Dabs along an arc over the ball, across several charts.
Stroke arc(Brush brush, vec3 from, vec3 to, int count = 9, float radius = 0.5f) {
    Stroke stroke{brush, {}, {}};
    for (int i = 0; i < count; ++i) {
        const vec3 normal = glm::normalize(glm::mix(from, to, float(i) / float(count - 1)));
        stroke.dabs.push_back({radius * normal, normal, 0.5f + 0.5f * float(i % 2)});
    }
    return stroke;
}

vec4 readAt(const Image& map, vec2 place) {
    const vec2 at = place - 0.5f, first = glm::floor(at), part = at - first;
    const auto texel = [&](int x, int y) {
        const float* p = map.at(int(first.x) + x, int(first.y) + y);
        return vec4(p[0], p[1], p[2], p[3]);
    };
    return glm::mix(glm::mix(texel(0, 0), texel(1, 0), part.x), glm::mix(texel(0, 1), texel(1, 1), part.x),
                    part.y);
}

// Calls `check(place, value)` at places all over the surface with what bilinear reading finds there.
template <class Check>
void forEachPlace(const Atlas& atlas, const Image& map, Check check) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> share(0, 1);
    const std::vector<std::uint32_t>& corners = atlas.mesh->indices;
    for (std::size_t t = 0; t < corners.size(); t += 3) {
        float u = share(random), v = share(random);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const auto mixed = [&](const auto& list) {
            return list[corners[t]] * (1 - u - v) + list[corners[t + 1]] * u + list[corners[t + 2]] * v;
        };
        check(mixed(atlas.mesh->positions), readAt(map, mixed(atlas.places)));
    }
}

const Atlas& atlasFor(const Object& object, int side) { return **atlasOf(object, side); }

TEST(Canvas, ADabHasItsShapeOnBothSidesOfEverySeam) {
    const Object object = ball();
    constexpr int kSide = 256;
    constexpr float kRadius = 0.2f, kHardness = 0.3f;
    for (const vec3& way : {vec3(0, -1, 0), vec3(0.8f, -0.5f, 0.1f), vec3(1, 1, 1), vec3(-1, 0.2f, 1)}) {
        Canvas canvas = canvasOn(object, kSide);
        const vec3 normal = glm::normalize(way);
        canvas.add(
            {{.value = vec3(0), .radius = kRadius, .hardness = kHardness}, {{0.5f * normal, normal, 1}}, {}});
        float worst = 0;
        int inside = 0;
        forEachPlace(atlasFor(object, kSide), *canvas.leaving(), [&](vec3 place, vec4 value) {
            const float away = glm::length(place - 0.5f * normal) / kRadius;
            const float t = glm::clamp((away - kHardness) / (1 - kHardness), 0.0f, 1.0f);
            const float wanted = t * t * (3 - 2 * t); // 0 where painted, 1 outside
            worst = std::max(worst, std::abs(value.a - wanted));
            inside += away < 1;
        });
        EXPECT_GT(inside, 100);
        // A texel is 0.011 m at most where charts are steep: 0.08 of what the dab falls over, (0.08)² 6 / 8
        // at its bends.
        EXPECT_LT(worst, 0.012f);
    }
}

TEST(Canvas, StrokesDoNotDependOnTheOrderOfDabs) {
    const Object object = ball();
    Stroke stroke = arc({.map = PaintMap::Glow, .value = {2, 0.5f, 1}, .radius = 0.15f, .strength = 0.7f},
                        {0, -1, 0.2f}, {1, 0.5f, 0});
    Canvas one = canvasOn(object, 128), other = canvasOn(object, 128);
    one.add(stroke);
    std::reverse(stroke.dabs.begin(), stroke.dabs.end());
    other.begin(stroke.brush);
    for (const Dab& dab : stroke.dabs)
        other.dab(dab);
    other.end();
    EXPECT_EQ(one.entering()->pixels, other.entering()->pixels);
    EXPECT_NE(one.entering()->pixels, canvasOn(object, 128).entering()->pixels);
    EXPECT_EQ(one.leaving()->pixels, canvasOn(object, 128).leaving()->pixels);
    float most = 0;
    for (std::size_t i = 0; i < one.entering()->pixels.size(); i += 4)
        most = std::max(most, one.entering()->pixels[i]);
    EXPECT_FLOAT_EQ(most, 1.7f); // 0.7 of the way from 1 to 2, though dabs overlap
}

TEST(Canvas, ValuesBlendAsTheirMapsDo) {
    const Object object = ball();
    const auto filled = [&](Brush brush) {
        Canvas canvas = canvasOn(object, 64);
        canvas.add({brush, {}, Stroke::Fill{vec3(-1), vec3(1)}});
        const std::uint32_t any = surfaceOf(object, 64)->texels().front().number;
        const int x = int(any % 64), y = int(any / 64);
        return std::pair{*canvas.entering()->at(x, y),
                         std::array{canvas.entering()->at(x, y)[3], *canvas.leaving()->at(x, y),
                                    canvas.leaving()->at(x, y)[3]}};
    };
    EXPECT_EQ(filled({.map = PaintMap::Blur, .value = vec3(4)}).second[0], 0.25f);
    EXPECT_FLOAT_EQ(filled({.map = PaintMap::Blur, .value = vec3(4), .strength = 0.5f}).second[0], 0.5f);
    EXPECT_EQ(filled({.map = PaintMap::Glow, .value = vec3(3)}).first, 3);
    EXPECT_EQ(filled({.map = PaintMap::Outgoing, .value = vec3(0.25f), .strength = 0.5f}).second[1], 0.625f);
    EXPECT_EQ(filled({.map = PaintMap::Translucency, .value = vec3(0)}).second[2], 0);
}

TEST(Canvas, AFillFollowsVeins) {
    const Object object = ball();
    const auto filled = [&](float veins) {
        Canvas canvas = canvasOn(object, 128);
        canvas.add(
            {{.map = PaintMap::Outgoing, .value = vec3(0)}, {}, Stroke::Fill{vec3(-2), vec3(2), veins}});
        std::vector<float> values;
        for (const PaintSurface::Texel& texel : surfaceOf(object, 128)->texels())
            values.push_back(canvas.leaving()->pixels[4 * texel.number]);
        return values;
    };
    const std::vector<float> wide = filled(0.5f), fine = filled(0.1f);
    for (const std::vector<float>& values : {wide, fine}) {
        const auto [least, most] = std::minmax_element(values.begin(), values.end());
        EXPECT_LT(*least, 0.1f); // in the middle of a vein
        EXPECT_GT(*most, 0.99f); // between two
        // Along a line across sheets the strength is the mean of (1 - x)^6 over [0,1], 1/7; noise bends
        // sheets and changes no share of them by more than half.
        const float mean = std::accumulate(values.begin(), values.end(), 0.0f) / float(values.size());
        EXPECT_NEAR(1 - mean, 1.0f / 7, 0.07f);
    }
    EXPECT_NE(wide, fine);
    EXPECT_EQ(filled(0), std::vector<float>(wide.size(), 0.0f));
}

TEST(Canvas, VeinsAreSmooth) {
    // The steepest place: 12 of the sheet's own slope, times that of the noise that bends it, 1 + 5 octaves
    // of 3.
    for (int i = 0; i < 1000; ++i) {
        const vec3 place(0.37f * float(i), 0.11f * float(i), -0.23f * float(i));
        EXPECT_NEAR(veinAt(place), veinAt(place + vec3(1e-4f)), 12 * 16 * 2e-4f);
    }
}

TEST(Painting, LiesOnTopWhereEveryStrokeDoes) {
    Painting painting;
    EXPECT_TRUE(painting.isOnTop());
    painting.strokes = {{{.map = PaintMap::Outgoing}, {}, Stroke::Fill{vec3(-1), vec3(1), 0.1f}}};
    EXPECT_TRUE(painting.isOnTop());
    painting.strokes.push_back({{.map = PaintMap::Glow}, {}, {}});
    EXPECT_FALSE(painting.isOnTop());
    painting.strokes.clear();
    painting.leavingFile = "leaving.png"; // whose alpha says how much goes inside
    EXPECT_FALSE(painting.isOnTop());
}

TEST(Canvas, UndoAndRedoComeBackToTheBitWhateverRoomThereIs) {
    const Object object = ball();
    std::vector<Stroke> strokes;
    for (int i = 0; i < 12; ++i)
        strokes.push_back(arc({.map = PaintMap(i % 4),
                               .value = vec3(0.1f * float(i + 1)),
                               .radius = 0.05f + 0.01f * float(i),
                               .strength = 0.9f,
                               .erase = i == 7,
                               .symmetric = i % 3 == 0},
                              {std::cos(float(i)), std::sin(float(i)), 0.3f}, {0, 1, -float(i) / 6}));
    strokes[5].dabs.clear();
    strokes[5].fill = Stroke::Fill{vec3(0), vec3(1), 0.25f};
    for (const std::size_t budget : {std::size_t(0), std::size_t(300000), Canvas::kBudget}) {
        SCOPED_TRACE(std::to_string(budget) + " bytes");
        Canvas canvas = canvasOn(object, 100, budget);
        std::vector<Image> entering, leaving;
        const auto expectState = [&](std::size_t number) {
            EXPECT_EQ(canvas.strokes().size(), number);
            EXPECT_EQ(canvas.entering()->pixels, entering[number].pixels) << "after " << number;
            EXPECT_EQ(canvas.leaving()->pixels, leaving[number].pixels) << "after " << number;
            EXPECT_LE(canvas.bytes(), budget);
        };
        for (std::size_t i = 0; i <= strokes.size(); ++i) {
            entering.push_back(*canvas.entering());
            leaving.push_back(*canvas.leaving());
            if (i < strokes.size()) canvas.add(strokes[i]);
        }
        for (std::size_t i = strokes.size(); i-- > 0;) {
            ASSERT_TRUE(canvas.undo());
            expectState(i);
        }
        EXPECT_FALSE(canvas.undo());
        for (std::size_t i = 1; i <= strokes.size(); ++i) {
            ASSERT_TRUE(canvas.redo());
            expectState(i);
        }
        EXPECT_FALSE(canvas.redo());
        canvas.undo();
        canvas.add(strokes[0]); // what was undone is gone
        EXPECT_FALSE(canvas.redo());
    }
}

TEST(Canvas, WhatWasShownNeverChanges) {
    const Object object = ball();
    Canvas canvas = canvasOn(object, 64);
    const auto entering = canvas.entering(), leaving = canvas.leaving();
    const Image before = *leaving;
    canvas.add(arc({.value = vec3(0), .radius = 0.2f}, {1, 0, 0}, {0, 0, 1}));
    EXPECT_EQ(leaving->pixels, before.pixels);
    EXPECT_NE(canvas.leaving(), leaving);
    EXPECT_EQ(canvas.entering(), entering); // this brush leaves it alone
    EXPECT_EQ(canvas.leaving(), canvas.leaving());
}

TEST(Canvas, EraseBringsBackTheUnpaintedValue) {
    const Object object = ball();
    Canvas canvas = canvasOn(object, 64);
    const Image before = *canvas.entering();
    const Stroke stroke =
        arc({.map = PaintMap::Blur, .value = vec3(3), .radius = 0.2f}, {1, 0, 0}, {0, 1, 0});
    canvas.add(stroke);
    EXPECT_NE(canvas.entering()->pixels, before.pixels);
    canvas.add({{.map = PaintMap::Blur, .erase = true}, {}, Stroke::Fill{vec3(-1), vec3(1)}});
    EXPECT_EQ(canvas.entering()->pixels, before.pixels);
}

constexpr float kEndless = std::numeric_limits<float>::infinity();

TEST(Canvas, EraseBringsAnOpaqueStartBack) {
    const auto filledWith = [&](Brush brush, float low = -kEndless) {
        return Stroke{brush, {}, Stroke::Fill{vec3(low), vec3(kEndless)}};
    };
    const Stroke opaque = filledWith({.value = vec3(0)}), erased = filledWith({.erase = true});
    const Stroke stroke = arc({.value = vec3(1), .radius = 0.2f}, {1, 0, 0}, {0, 1, 0});
    EXPECT_EQ(startOf({}), 1);
    EXPECT_EQ(startOf(std::array{opaque, stroke}), 0);
    EXPECT_EQ(startOf(std::array{stroke, opaque}), 1);
    EXPECT_EQ(startOf(std::array{filledWith({.value = vec3(0)}, 0)}), 1); // a part of it
    EXPECT_EQ(startOf(std::array{filledWith({.map = PaintMap::Glow, .value = vec3(0)})}), 1);

    const Object object = ball();
    for (const std::size_t budget : {Canvas::kBudget, std::size_t(0)}) { // undone from tiles, or painted anew
        Canvas canvas(*paintSurfaceOf(object, 64), 1, nullptr, nullptr, budget);
        canvas.add(opaque);
        const Image before = *canvas.leaving();
        canvas.add(stroke);
        const Image painted = *canvas.leaving();
        canvas.add(erased);
        EXPECT_EQ(canvas.leaving()->pixels, before.pixels);
        EXPECT_TRUE(canvas.undo());
        EXPECT_EQ(canvas.leaving()->pixels, painted.pixels);
        EXPECT_TRUE(canvas.redo());
        EXPECT_EQ(canvas.leaving()->pixels, before.pixels);

        // Strokes that are in the maps already say how it began.
        Canvas later(*paintSurfaceOf(object, 64), 1, nullptr, std::make_shared<Image>(painted), budget, 0);
        later.add(erased);
        EXPECT_EQ(later.leaving()->pixels, before.pixels);
    }
}

TEST(Canvas, SymmetricPaintsBothSidesAlike) {
    const Object object = ball();
    const vec3 normal = glm::normalize(vec3(1, 0.3f, 0.5f));
    for (const bool symmetric : {false, true}) {
        Canvas canvas = canvasOn(object, 256);
        canvas.add({{.value = vec3(0), .radius = 0.2f, .hardness = 0, .symmetric = symmetric},
                    {{0.5f * normal, normal, 1}},
                    {}});
        float nearest = 1, mirrored = 1;
        forEachPlace(atlasFor(object, 256), *canvas.leaving(), [&](vec3 place, vec4 value) {
            if (glm::length(place - 0.5f * normal) < 0.03f) nearest = std::min(nearest, value.a);
            if (glm::length(place * vec3(-1, 1, 1) - 0.5f * normal) < 0.03f)
                mirrored = std::min(mirrored, value.a);
        });
        EXPECT_LT(nearest, 0.1f);
        EXPECT_EQ(mirrored < 1, symmetric);
        if (symmetric) {
            EXPECT_LT(mirrored, 0.1f);
        }
    }
}

TEST(Canvas, BrushesAreMeasuredInTheWorldAndKeepToTheirSide) {
    Object object;
    object.shape = Box{{1, 0.01f, 1}};
    Canvas canvas = canvasOn(object, 128);
    object.transform.scale = 2;
    Canvas large = canvasOn(object, 128);
    const Dab dab{{0, 0.005f, 0}, {0, 1, 0}, 1};
    canvas.add({{.value = vec3(0), .radius = 0.1f}, {dab}, {}});
    large.add({{.value = vec3(0), .radius = 0.2f}, {dab}, {}});
    EXPECT_EQ(canvas.leaving()->pixels, large.leaving()->pixels);
    forEachPlace(atlasFor(object, 128), *canvas.leaving(), [&](vec3 place, vec4 value) {
        if (place.y < 0.004f) {
            EXPECT_EQ(value.a, 1) << "below, at " << place.x << ", " << place.z;
        }
    });
}

std::vector<Stroke> examples() {
    constexpr float kEndless = std::numeric_limits<float>::infinity();
    return {{{.value = vec3(0)}, {}, Stroke::Fill{vec3(-kEndless), vec3(kEndless)}},
            arc({.map = PaintMap::Glow,
                 .value = {0.1f, 2.7182817f, 1e-20f},
                 .radius = 0.123456789f,
                 .hardness = 0.3f,
                 .strength = 0.7f,
                 .symmetric = true},
                {1, 0.1f, 0}, {0, 0.3f, 1}),
            {{.map = PaintMap::Blur, .value = vec3(1 / 3.0f)},
             {},
             Stroke::Fill{{0, -kEndless, 0.1f}, {1, 2, kEndless}}},
            {{.map = PaintMap::Outgoing, .erase = true}, {{{1, 2, 3}, {0, 0, 1}, 0}}, {}}};
}

void expectSame(const std::vector<Stroke>& a, const std::vector<Stroke>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Brush &p = a[i].brush, &q = b[i].brush;
        EXPECT_EQ(p.map, q.map);
        EXPECT_TRUE(p.erase || p.value == q.value);
        EXPECT_EQ(std::tie(p.radius, p.hardness, p.strength, p.erase, p.symmetric),
                  std::tie(q.radius, q.hardness, q.strength, q.erase, q.symmetric));
        ASSERT_EQ(a[i].dabs.size(), b[i].dabs.size());
        for (std::size_t k = 0; k < a[i].dabs.size(); ++k) {
            EXPECT_EQ(a[i].dabs[k].place, b[i].dabs[k].place);
            EXPECT_EQ(a[i].dabs[k].normal, b[i].dabs[k].normal);
            EXPECT_EQ(a[i].dabs[k].pressure, b[i].dabs[k].pressure);
        }
        ASSERT_EQ(bool(a[i].fill), bool(b[i].fill));
        if (a[i].fill) {
            EXPECT_EQ(a[i].fill->low, b[i].fill->low);
            EXPECT_EQ(a[i].fill->high, b[i].fill->high);
        }
    }
}

Result<std::vector<Stroke>> parsed(std::string_view text) {
    return parseStrokes(std::as_bytes(std::span(text.data(), text.size())), "a.json");
}

TEST(Strokes, ReadBackToTheBit) {
    const auto back = parsed(toJson(examples()));
    ASSERT_TRUE(back) << back.error().message;
    expectSame(*back, examples());
}

TEST(Strokes, ComplaintsNameTheirPlace) {
    const auto messageOf = [](std::string_view stroke) {
        const auto read = parsed(R"({ "lucentStrokes": 1, "strokes": [
)" + std::string(stroke) + "] }");
        return read ? std::string("no complaint") : read.error().message;
    };
    EXPECT_EQ(messageOf(R"({ "brush": "glov", "value": 1, "fill": {} })"),
              "a.json:2: strokes.0.brush is \"glov\"; must be translucency, blur, glow or outgoing");
    EXPECT_EQ(messageOf(R"({ "brush": "blur", "value": 17, "fill": {} })"),
              "a.json:2: strokes.0.value is 17; must be in [0.0625, 16]");
    EXPECT_EQ(messageOf(R"({ "brush": "glow", "value": 1, "fill": {} })"),
              "a.json:2: strokes.0.value is 1; must be a list of 3 numbers or \"#rrggbb\"");
    EXPECT_EQ(messageOf(R"({ "brush": "blur", "fill": {} })"),
              "a.json:2: strokes.0.value is missing; must be a number");
    EXPECT_EQ(messageOf(R"({ "brush": "blur", "erase": true, "value": 1, "fill": {} })"),
              "a.json:2: strokes.0.value does nothing beside erase; must be left out");
    EXPECT_EQ(messageOf(R"({ "brush": "blur", "value": 1 })"),
              "a.json:2: strokes.0 has neither dabs nor fill; must have one of them");
    EXPECT_EQ(messageOf(R"({ "brush": "blur", "value": 1, "dabs": [[0, 0, 0, 0, 0, 1]] })"),
              "a.json:2: strokes.0.dabs.0 is a list; must be a list of 7 numbers");
    EXPECT_EQ(messageOf(R"({ "brush": "blur", "value": 1, "dabs": [[0, 0, 0, 0, 0, 1, 2]] })"),
              "a.json:2: strokes.0.dabs.0 has the pressure 2; must be in [0, 1]");
    EXPECT_EQ(messageOf(R"({ "brush": "blur", "value": 1, "radios": 1, "fill": {} })"),
              "a.json:2: strokes.0.radios is an unknown key; the nearest is \"radius\"");
    EXPECT_EQ(parsed(R"({ "strokes": [] })").error().message,
              "a.json:1: lucentStrokes is missing; must be 1");
}

std::string sceneWith(const std::string& paint, const std::string& material = R"({ "preset": "marble" })") {
    return R"({ "lucent": 1, "objects": [
{ "name": "ball", "shape": { "type": "sphere", "radius": 0.5 }, "material": )" +
           material + ", \"paint\":\n" + paint + "} ] }";
}

test::Files filesWith(const std::string& name, const Bytes& bytes) {
    test::Files files;
    files.content[name] = bytes;
    return files;
}

TEST(Painting, ComesFromStrokesOrFilesAndIsWrittenBack) {
    const std::string script = toJson(examples());
    test::Files files;
    files.put("scenes/s.json", script);
    const Result<Scene> scene = test::load(files, sceneWith(R"({ "strokes": "s.json", "side": 96 })"));
    ASSERT_TRUE(scene) << scene.error().message;
    const Painting& painting = *scene->objects[0].painting;
    EXPECT_EQ(painting.side(), 96);
    expectSame(painting.strokes, examples());
    // The strokes in the scene itself, as written where they came from no file.
    const std::string list = script.substr(script.find('['), script.rfind(']') + 1 - script.find('['));
    const Result<Scene> whole = test::load(files, sceneWith(R"({ "side": 96, "strokes": )" + list + "}"));
    ASSERT_TRUE(whole) << whole.error().message;
    for (const Scene* one : {&*scene, &*whole}) {
        const Result<Scene> back = test::load(files, toJson(*one));
        ASSERT_TRUE(back) << back.error().message;
        EXPECT_EQ(back->objects[0].painting->entering->pixels, painting.entering->pixels);
        EXPECT_EQ(back->objects[0].painting->leaving->pixels, painting.leaving->pixels);
        EXPECT_EQ(back->objects[0].painting->strokesFile, one == &*scene ? "s.json" : "");
    }
    const auto named = dependencies("scenes/a.json", files.content["scenes/s.json"]);
    const std::string text = sceneWith(R"({ "entering": "e.exr", "strokes": "s.json" })");
    EXPECT_EQ(*dependencies("scenes/a.json", std::as_bytes(std::span(text))),
              (std::vector<std::string>{"scenes/e.exr", "scenes/s.json"}));
}

TEST(Painting, MapsKeepEveryBitInExr) {
    const auto painted = paint(ball(), examples(), 64);
    ASSERT_TRUE(painted) << painted.error().message;
    test::Files files;
    const ReadFile none = files.reader();
    for (const auto& [name, map] :
         {std::pair{"scenes/e.exr", (*painted)->entering}, {"scenes/l.exr", (*painted)->leaving}})
        files.content[name] = *toPlain(name, *encodeExr(*map), none);
    const Result<Scene> scene =
        test::load(files, sceneWith(R"({ "entering": "e.exr", "leaving": "l.exr" })"));
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->objects[0].painting->entering->pixels, (*painted)->entering->pixels);
    EXPECT_EQ(scene->objects[0].painting->leaving->pixels, (*painted)->leaving->pixels);
    const Result<Scene> back = test::load(files, toJson(*scene));
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->objects[0].painting->leavingFile, "l.exr");
    // PNG keeps 256 steps.
    Image eights(16, 16, 4);
    std::fill(eights.pixels.begin(), eights.pixels.end(), 51 / 255.0f);
    const auto leaving = decodeLeaving(*encodeImage(eights, "l.png"), "l.png");
    ASSERT_TRUE(leaving) << leaving.error().message;
    EXPECT_EQ((*leaving)->pixels, eights.pixels);
}

TEST(Painting, ComplaintsSayWhatIsWrong) {
    const auto messageOf = [](const test::Files& files, const std::string& paint,
                              const std::string& material) {
        const Result<Scene> scene = test::load(files, sceneWith(paint, material));
        return scene ? std::string("no complaint") : scene.error().message;
    };
    const auto withMap = [&](Image map, const char* key = "entering") {
        return messageOf(filesWith("scenes/m.pfm", map.channels == 4 ? *toPlain("m.exr", *encodeExr(map), {})
                                                                     : *encodeImage(map, "m.pfm")),
                         "{ \"" + std::string(key) + R"(": "m.pfm" })", R"({ "preset": "marble" })");
    };
    Image map(16, 16, 4);
    std::fill(map.pixels.begin(), map.pixels.end(), 1.0f);
    EXPECT_EQ(withMap(map), "no complaint");
    Image bad = map;
    bad.at(3, 2)[3] = 17;
    EXPECT_EQ(withMap(bad),
              "scenes/a.json:3: objects.ball.paint.entering: scenes/m.pfm: texel (3, 2) is 17; the sharpness "
              "in alpha must be in [0.0625, 16]");
    EXPECT_EQ(withMap(bad, "leaving"),
              "scenes/a.json:3: objects.ball.paint.leaving: scenes/m.pfm: texel (3, 2) is 17; the "
              "translucency in alpha must be in [0, 1]");
    bad = map;
    bad.at(0, 0)[1] = std::nanf("");
    EXPECT_EQ(
        withMap(bad),
        "scenes/a.json:3: objects.ball.paint.entering: scenes/m.pfm: texel (0, 0) is nan; red, green and "
        "blue must be in [0, 1e+06]");
    EXPECT_EQ(withMap(Image(20, 16, 3)),
              "scenes/a.json:3: objects.ball.paint.entering: scenes/m.pfm: is 20 x 16 texels; "
              "painted maps must be square, 16 to 4096 a side");
    EXPECT_EQ(withMap(Image(16, 16, 1)),
              "scenes/a.json:3: objects.ball.paint.entering: scenes/m.pfm: has 1 channels; "
              "painted maps must have 3 or 4");
    test::Files two = filesWith("scenes/m.pfm", *encodeImage(Image(16, 16, 3), "m.pfm"));
    two.put("scenes/n.pfm", Image(32, 32, 3));
    const std::string marble = R"({ "preset": "marble" })", fill = R"({ "strokes": [] })";
    EXPECT_EQ(
        messageOf(two, R"({ "entering": "m.pfm", "leaving": "n.pfm" })", marble),
        "scenes/a.json:2: objects.ball.paint has maps of 16 and 32 texels a side; must be equally large");
    EXPECT_EQ(messageOf(two, R"({ "leaving": "n.pfm", "side": 32 })", marble),
              "scenes/a.json:3: objects.ball.paint.side is given beside maps; must stand without them");
    EXPECT_EQ(messageOf(two, "{}", marble),
              "scenes/a.json:2: objects.ball.paint holds no paint; must have entering, leaving or strokes");
    EXPECT_EQ(
        messageOf(two, R"({ "strokes": 3 })", marble),
        "scenes/a.json:3: objects.ball.paint.strokes is 3; must be the name of a file or a list of strokes");
    EXPECT_EQ(messageOf(two, fill, R"({ "diffuse": [1, 0, 0] })"),
              "scenes/a.json:2: objects.ball.paint does nothing where nothing scatters; must stand on a "
              "translucent object");
    EXPECT_EQ(messageOf(two, fill, R"({ "preset": "marble", "diffuse": [1, 0, 0] })"),
              "no complaint"); // the matt share
}

} // namespace
} // namespace lucent::scene
