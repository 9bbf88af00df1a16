#pragma once
/// What was worked out from a thing, kept with it.

#include <deque>
#include <map>
#include <memory>
#include <utility>

namespace lucent {

/// Results by what they were worked out from, which is compared by value; the last few of each kind. It is a
/// member of a thing, shared by the thing's copies, and its memory goes with the last of them. Not for
/// several threads at once.
class Kept {
public:
    Kept() = default;
    Kept(const Kept&) = default; // and no moving: what was moved from may be used again
    Kept& operator=(const Kept&) = default;

    /// The result for a key; null when it is not there.
    template <class Value, class Key>
    const Value* find(const Key& key) const {
        for (const auto& [known, value] : list<Key, Value>())
            if (known == key) return &value;
        return nullptr;
    }
    template <class Value, class Key>
    const Value& keep(Key key, Value value) const {
        auto& all = list<Key, Value>();
        if (all.size() == kMost) all.pop_front();
        return all.emplace_back(std::move(key), std::move(value)).second;
    }
    /// The result for a key, made where it is not there.
    template <class Value, class Key, class Make>
    const Value& of(Key key, const Make& make) const {
        const Value* found = find<Value>(key);
        return found ? *found : keep<Value>(std::move(key), Value(make()));
    }

private:
    static constexpr std::size_t kMost = 8;
    template <class Key, class Value>
    static inline char kind = 0; // its address
    template <class Key, class Value>
    auto& list() const {
        using List = std::deque<std::pair<Key, Value>>; // what it holds stays where it is
        std::shared_ptr<void>& all = (*lists_)[&kind<Key, Value>];
        if (!all) all = std::make_shared<List>();
        return *static_cast<List*>(all.get());
    }
    using Lists = std::map<const void*, std::shared_ptr<void>>;
    std::shared_ptr<Lists> lists_ = std::make_shared<Lists>();
};

} // namespace lucent
