#include "viewer/Figure.h"

namespace lucent::viewer {

std::vector<Figure> figuresOf(const scene::Scene& scene, double ms) {
    std::vector<Figure> all;
    for (const PanelPart* part : panelParts())
        for (Figure& figure : part->figures(scene, ms))
            all.push_back(std::move(figure));
    return all;
}

std::string figuresJson(const std::vector<Figure>& figures) {
    std::string text = "[";
    for (const Figure& figure : figures)
        text += (text.size() > 1 ? ",\n" : "") + figure.json;
    return text + "]\n";
}

} // namespace lucent::viewer
