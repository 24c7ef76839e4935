// The fuzz bodies of the program that replays their corpora.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string_view>

using ReplayBody = int (*)(const std::uint8_t* data, std::size_t size);

// By name. Each adds itself before main(): see replay_body.cpp.in.
std::map<std::string_view, ReplayBody>& replay_bodies();
