/// What scripts of several engines have in common.
#pragma once

#include <string_view>

namespace skyloop {

/// POSIX sh: runs the command in "$@" as a child, passes SIGTERM and SIGINT on to it, and leaves its exit code in
/// `code`. A wait that a signal ended is taken up again.
inline constexpr std::string_view run_child = R"(child=
trap '[ -z "$child" ] || kill -TERM "$child"' TERM INT
"$@" &
child=$!
while :; do
    wait "$child"
    code=$?
    kill -0 "$child" 2>/dev/null || break
done
)";

}  // namespace skyloop
