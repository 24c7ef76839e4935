/// One callable of several, for std::visit.
#pragma once

namespace skyloop {

/// Takes what any of its parts takes: Overloaded{[](int) { … }, [](double) { … }}.
template <class... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};
// Clang 14 does not yet deduce it for aggregates.
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

}  // namespace skyloop
