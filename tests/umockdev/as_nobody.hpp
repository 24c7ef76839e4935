/// Being somebody who may open nothing that is forbidden.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

namespace skyloop::mock {

/// While it lives the process is not the superuser, who may open everything.
class AsNobody {
public:
    AsNobody() { EXPECT_EQ(setresuid(other_, other_, self_), 0); }
    ~AsNobody() { EXPECT_EQ(setresuid(self_, self_, self_), 0); }
    AsNobody(const AsNobody&) = delete;
    AsNobody& operator=(const AsNobody&) = delete;

private:
    uid_t self_ = geteuid();
    uid_t other_ = self_ == 0 ? 65534 : self_;
};

}  // namespace skyloop::mock
