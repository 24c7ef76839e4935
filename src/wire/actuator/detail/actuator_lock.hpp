/// What keeps two runs from one switch.
#pragma once

#include <memory>
#include <string>

#include "base/core/result.hpp"

namespace skyloop {

/// A name that one switch of the machine has at a time; the kernel takes it back however a program ends. It is an
/// abstract socket, which needs no folder that all users may write to, and leaves nothing behind. Containers with a
/// network of their own do not see each other's.
class ActuatorLock {
public:
    /// Fails with `outside` when somebody has it. Null: the system has no such names to give.
    static Result<std::unique_ptr<ActuatorLock>> take(const std::string& name);
    ~ActuatorLock();
    ActuatorLock(const ActuatorLock&) = delete;
    ActuatorLock& operator=(const ActuatorLock&) = delete;

private:
    explicit ActuatorLock(int socket) : socket_(socket) {}
    int socket_;
};

}  // namespace skyloop
