#include "wire/transport/file_descriptor.hpp"

#include <unistd.h>

namespace skyloop {

FileDescriptor::~FileDescriptor() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace skyloop
