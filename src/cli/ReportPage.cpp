#include "cli/ReportPage.h"

#include "base/File.h"
#include "base/Text.h"
#include "scene/Json.h"

#include <filesystem>

namespace lucent::cli {

namespace {
constexpr std::string_view kPlace = R"(<script type="application/json" id="reports">[]</script>)";

// A script element ends at the first "</script", even inside a text of JSON.
std::string embeddable(std::string json) {
    for (std::size_t at = json.find("</"); at != std::string::npos; at = json.find("</", at + 3))
        json.replace(at, 2, "<\\/");
    return json;
}
} // namespace

Status checkReport(const std::string& json, const std::string& name) {
    const Result<scene::Json> parsed = scene::parseJson(std::as_bytes(std::span(json)), name);
    if (!parsed) return parsed.error();
    const scene::Json* format = parsed->find("format");
    if (!format || format->string != "lucent-bench-1")
        return Error{name + ": format is " + (format ? format->describe() : "missing") +
                     "; must be \"lucent-bench-1\", as lucent bench writes it"};
    return Done{};
}

Result<std::string> reportPage(const std::vector<std::string>& reports) {
    const auto program = std::filesystem::read_symlink("/proc/self/exe");
    const std::string path = (program.parent_path() / "report_page.html").string();
    const Result<Bytes> bytes = readFile(path);
    if (!bytes)
        return Error{bytes.error().message + "; the build makes it beside the program", Fault::Machine};
    std::string page(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    const std::size_t place = page.find(kPlace);
    if (place == std::string::npos)
        return Error{path + ": has no place for reports; must be the page that the build makes",
                     Fault::Machine};
    std::string all;
    for (const std::string& report : reports)
        all += (all.empty() ? "" : ",\n") + embeddable(report);
    return page.replace(place + kPlace.find("[]"), 2, "[" + all + "]");
}

} // namespace lucent::cli
