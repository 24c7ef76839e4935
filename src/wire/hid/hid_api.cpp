#include "detail/hid_api.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <string>

namespace skyloop {
namespace {

struct Library {
    const char* file;
    const char* package;
};

Library library_of(HidBackend backend) {
    if (backend == HidBackend::hidraw) return {"libhidapi-hidraw.so.0", "libhidapi-hidraw0"};
    return {"libhidapi-libusb.so.0", "libhidapi-libusb0"};
}

template <class Function>
bool find(void* library, const char* name, Function& function) {
    function = reinterpret_cast<Function>(dlsym(library, name));
    return function != nullptr;
}

Result<HidApi> load(HidBackend backend) {
    const Library library = library_of(backend);
    // Local and bound to itself: the other backend has the same names.
    void* loaded = dlopen(library.file, RTLD_NOW | RTLD_LOCAL);
    if (loaded == nullptr)
        return fail(ErrorCode::outside, fmt::format("cannot use HID devices: {} is not on this machine (package {})",
                                                    library.file, library.package));
    HidApi api{};
    api.backend = backend;
    const bool whole =
        find(loaded, "hid_init", api.initialize) && find(loaded, "hid_exit", api.finish) &&
        find(loaded, "hid_enumerate", api.enumerate) && find(loaded, "hid_free_enumeration", api.free_enumeration) &&
        find(loaded, "hid_open_path", api.open_path) && find(loaded, "hid_close", api.close) &&
        find(loaded, "hid_write", api.write) && find(loaded, "hid_read_timeout", api.read_timeout) &&
        find(loaded, "hid_send_feature_report", api.send_feature_report) &&
        find(loaded, "hid_get_feature_report", api.get_feature_report) && find(loaded, "hid_error", api.error);
    if (!whole || api.initialize() != 0)
        return fail(ErrorCode::outside, fmt::format("cannot use HID devices: {} {}", library.file,
                                                    whole ? "does not start" : "is no hidapi"));
    return api;
}

}  // namespace

Result<const HidApi*> hid_api(HidBackend backend) {
    static const Result<HidApi> hidraw = load(HidBackend::hidraw);
    static const Result<HidApi> libusb = load(HidBackend::libusb);
    const Result<HidApi>& api = backend == HidBackend::hidraw ? hidraw : libusb;
    if (!api) return fail(api.error());
    return &*api;
}

}  // namespace skyloop
