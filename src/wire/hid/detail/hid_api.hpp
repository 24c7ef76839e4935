/// The functions of one backend of hidapi, found in its library when first asked for.
#pragma once

#include <hidapi/hidapi.h>

#include "base/core/result.hpp"
#include "wire/hid/hid_device.hpp"

namespace skyloop {

struct HidApi {
    HidBackend backend;
    decltype(&hid_init) initialize;
    decltype(&hid_exit) finish;
    decltype(&hid_enumerate) enumerate;
    decltype(&hid_free_enumeration) free_enumeration;
    decltype(&hid_open_path) open_path;
    decltype(&hid_close) close;
    decltype(&hid_write) write;
    decltype(&hid_read_timeout) read_timeout;
    decltype(&hid_send_feature_report) send_feature_report;
    decltype(&hid_get_feature_report) get_feature_report;
    decltype(&hid_error) error;
};

/// Stays loaded until the program ends. Fails with `outside`: the library is not there, and which package has it.
Result<const HidApi*> hid_api(HidBackend backend);

}  // namespace skyloop
