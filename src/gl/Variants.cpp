#include "gl/Variants.h"

#include <algorithm>
#include <cstdlib>

namespace lucent::gl {

namespace {

struct Choice {
    std::string name;
    bool isNumber = false;
    int least = 0, most = 0;

    std::string with(int value) const { return name + " " + std::to_string(value); }
    bool is(const std::string& one) const {
        if (!isNumber) return one == name;
        const std::string head = name + " ";
        if (one.compare(0, head.size(), head) != 0) return false;
        const int value = std::atoi(one.c_str() + head.size());
        return value >= least && value <= most && one == with(value);
    }
    Switches ends() const {
        if (!isNumber) return {name};
        return least == most ? Switches{with(least)} : Switches{with(least), with(most)};
    }
};

// One line.
struct Group {
    bool isOptional = false;
    std::vector<Choice> choices;
    std::vector<std::string> conditions; // one of these is on; empty: always
    bool isUnless = false;               // or rather none of them

    bool applies(const Switches& on) const {
        const auto isOn = [&](const std::string& one) {
            return std::find(on.begin(), on.end(), one) != on.end();
        };
        return conditions.empty() || std::any_of(conditions.begin(), conditions.end(), isOn) != isUnless;
    }
    bool has(const std::string& one) const {
        return std::any_of(choices.begin(), choices.end(),
                           [&](const Choice& choice) { return choice.is(one); });
    }
};

// "NAME", "NAME=8" or "NAME=1..8"
Choice choiceOf(const std::string& word) {
    const std::size_t equals = word.find('='), dots = word.find("..");
    if (equals == std::string::npos) return {.name = word};
    const int least = std::atoi(word.c_str() + equals + 1);
    return {.name = word.substr(0, equals),
            .isNumber = true,
            .least = least,
            .most = dots == std::string::npos ? least : std::atoi(word.c_str() + dots + 2)};
}

std::vector<std::string> split(std::string_view text, char at) {
    std::vector<std::string> parts;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(at), text.size());
        parts.emplace_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return parts;
}

std::vector<Group> groupsOf(std::string_view lines) {
    std::vector<Group> groups;
    for (const std::string& line : split(lines, '\n')) {
        Group& group = groups.emplace_back();
        bool isCondition = false;
        for (const std::string& word : split(line, ' ')) {
            if (word == "-")
                group.isOptional = true;
            else if (word == "if" || word == "unless")
                isCondition = true, group.isUnless = word == "unless";
            else if (isCondition)
                group.conditions.push_back(word);
            else
                group.choices.push_back(choiceOf(word));
        }
    }
    return groups;
}

// All ways to go on from what is on after the groups before.
void extend(const std::vector<Group>& groups, std::size_t next, Switches& on, std::vector<Switches>& list) {
    if (next == groups.size()) {
        list.push_back(on);
        return;
    }
    const Group& group = groups[next];
    const bool applies = group.applies(on);
    if (!applies || group.isOptional) extend(groups, next + 1, on, list);
    if (!applies) return;
    for (const Choice& choice : group.choices)
        for (const std::string& one : choice.ends()) {
            on.push_back(one);
            extend(groups, next + 1, on, list);
            on.pop_back();
        }
}

} // namespace

std::vector<Switches> variantsOf(std::string_view lines) {
    std::vector<Switches> list;
    Switches on;
    extend(groupsOf(lines), 0, on, list);
    return list;
}

bool isVariant(std::string_view lines, const Switches& switches) {
    std::size_t known = 0;
    for (const Group& group : groupsOf(lines)) {
        if (!group.applies(switches)) continue;
        const auto chosen = std::count_if(switches.begin(), switches.end(),
                                          [&](const std::string& one) { return group.has(one); });
        if (chosen > 1 || (chosen == 0 && !group.isOptional)) return false;
        known += std::size_t(chosen);
    }
    return known == switches.size();
}

} // namespace lucent::gl
