#include "viewer/Figure.h"

#include "base/JsonWriter.h"

namespace lucent::viewer {

std::vector<Figure> figuresOf(const scene::Scene& scene, double ms) {
    std::vector<Figure> all;
    for (const PanelPart* part : panelParts())
        for (Figure& figure : part->figures(scene, ms))
            all.push_back(std::move(figure));
    return all;
}

std::string figuresJson(const std::vector<Figure>& figures, bool numbers) {
    JsonWriter json;
    json.beginArray();
    for (const Figure& figure : figures)
        if (figure.isPending)
            json.beginObject().key("owner").value(figure.owner).key("pending").value(true).end();
        else if (numbers)
            json.raw(figure.json());
        else
            json.beginObject().key("owner").value(figure.owner).key("text").value(figure.text).end();
    return json.end().text();
}

} // namespace lucent::viewer
