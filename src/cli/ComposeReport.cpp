#include "cli/ComposeReport.h"

#include "base/Text.h"
#include "cli/Files.h"
#include "cli/ProgressBar.h"
#include "measure/BenchReport.h"
#include "measure/Compose.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>

namespace lucent::cli {

namespace fs = std::filesystem;
using measure::ComposeCell;

namespace {

std::string percent(double share) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f %%", 100 * share);
    return text;
}

// Worst first, by the target.
std::vector<const ComposeCell*> worstOf(const std::vector<ComposeCell>& cells, std::size_t most) {
    std::vector<const ComposeCell*> worst;
    for (const ComposeCell& cell : cells)
        if (cell.isMeasured()) worst.push_back(&cell);
    std::sort(worst.begin(), worst.end(), [](const ComposeCell* a, const ComposeCell* b) {
        return a->misplaced / a->target > b->misplaced / b->target;
    });
    worst.resize(std::min(worst.size(), most));
    return worst;
}

std::string fileOf(const ComposeCell& cell) {
    std::string name = cell.lamp + "-" + cell.between + "-" + cell.receiver;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == ' ' || c == '%'; }, '_');
    return "compose/" + name + ".png";
}

// The picture left, its truth right, as displayed.
Image besides(const ComposeCell& cell) {
    const int width = cell.picture.width;
    Image both(2 * width, cell.picture.height, 3);
    for (int y = 0; y < both.height; ++y)
        for (int x = 0; x < both.width; ++x) {
            const float* from = x < width ? cell.picture.at(x, y) : cell.truth.at(x - width, y);
            for (int channel = 0; channel < 3; ++channel) {
                const float value = std::clamp(from[channel], 0.0f, 1.0f);
                both.at(x, y)[channel] =
                    value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1 / 2.4f) - 0.055f;
            }
        }
    return both;
}

std::string cellHtml(const ComposeCell& cell) {
    if (!cell.message.empty()) return "<td class=bad title=\"" + cell.message + "\">refused</td>";
    const char* kind = cell.isMet() ? "good" : cell.misplaced <= 3 * cell.target ? "near" : "bad";
    return std::string("<td class=") + kind + " title=\"flux " + shortest(std::round(cell.flux * 1e4) / 1e4) +
           ", target " + percent(cell.target) + ", the truth's noise " + percent(cell.byNoise) +
           "\"><a href=\"" + fileOf(cell) + "\">" + percent(cell.misplaced) + "</a></td>";
}

std::string pageOf(const std::vector<ComposeCell>& cells, const std::vector<std::string_view>& lamps) {
    std::string page =
        "<!doctype html><meta charset=utf-8><title>Lucent: everything on everything</title><style>"
        "body{font:14px sans-serif;margin:2em}table{border-collapse:collapse;margin:1em 0}"
        "td,th{border:1px solid #ccc;padding:3px 8px;text-align:right}.good{background:#cfe8cf}"
        ".near{background:#f6e7b0}.bad{background:#f2b8b0}</style>"
        "<h1>Everything on everything</h1><p>Share of the light that lies elsewhere than in the exact "
        "solution. A click shows the picture beside its truth. Worst: ";
    for (const ComposeCell* cell : worstOf(cells, 5))
        page += cell->name() + " (" + percent(cell->misplaced) + "); ";
    page += "</p>";
    for (const std::string_view lamp : lamps) {
        page += "<h2>" + std::string(lamp) + "</h2><table><tr><th>";
        for (const std::string_view receiver : measure::composeReceivers())
            page += "<th>" + std::string(receiver);
        for (const std::string_view between : measure::composeBetween()) {
            page += "<tr><th>" + std::string(between);
            for (const std::string_view receiver : measure::composeReceivers())
                for (const ComposeCell& cell : cells)
                    if (cell.lamp == lamp && cell.between == between && cell.receiver == receiver)
                        page += cellHtml(cell);
        }
        page += "</table>";
    }
    return page;
}

} // namespace

Status benchCompose(gl::Context& context, const std::string& folder, bool quick, const std::string& some) {
    std::error_code failed;
    fs::create_directories(fs::path(folder) / "compose", failed);
    if (failed) return Error{folder + "/compose: cannot be made (" + failed.message() + ")"};
    std::vector<std::string_view> lamps(measure::composeLamps().begin(), measure::composeLamps().end());
    if (quick) lamps = {"distant", "environment"};
    std::vector<ComposeCell> wanted;
    for (const std::string_view lamp : lamps)
        for (const std::string_view between : measure::composeBetween())
            for (const std::string_view receiver : measure::composeReceivers()) {
                ComposeCell cell{std::string(lamp), std::string(between), std::string(receiver)};
                if (cell.name().find(some) != std::string::npos) wanted.push_back(std::move(cell));
            }
    if (wanted.empty())
        return Error{"--cells: is " + inQuotes(some) +
                     ", which no cell's name contains; must be part of one such as " +
                     inQuotes("spot / water / matt mesh")};
    std::vector<ComposeCell> cells;
    const auto start = std::chrono::steady_clock::now();
    for (const ComposeCell& one : wanted) {
        ComposeCell cell = measure::measureCompose(context, one.lamp, one.between, one.receiver);
        if (cell.isMeasured()) {
            const std::string path = folder + "/" + fileOf(cell);
            Result<Bytes> png = encode(besides(cell), path);
            if (!png) return png.error();
            if (Status written = writeAll({{path, std::move(*png)}}); !written) return written;
        }
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
        cells.push_back(std::move(cell));
        const ComposeCell& last = cells.back();
        std::fprintf(stderr, "bench: %s  %s: %s\n",
                     progressLine(double(cells.size()) / double(wanted.size()), elapsed.count()).c_str(),
                     last.name().c_str(),
                     last.isMeasured()
                         ? (percent(last.misplaced) + measure::formatted(", flux %.4f", last.flux)).c_str()
                         : last.message.c_str());
    }
    const auto count = [&](const auto& which) {
        return int(std::count_if(cells.begin(), cells.end(), which));
    };
    const int measured = count([](const ComposeCell& cell) { return cell.isMeasured(); });
    std::printf("compose: %d of %zu cells drawn, %d of these within their targets\n", measured, cells.size(),
                count([](const ComposeCell& cell) { return cell.isMet(); }));
    for (const ComposeCell* cell : worstOf(cells, 5))
        std::printf("  %s: %s misplaced (target %s), flux %.4f\n", cell->name().c_str(),
                    percent(cell->misplaced).c_str(), percent(cell->target).c_str(), cell->flux);
    return writeAll({{folder + "/compose.json", toBytes(measure::composeJson(cells))},
                     {folder + "/compose.html", toBytes(pageOf(cells, lamps))}});
}

} // namespace lucent::cli
