/// A modem line of a serial device as a switch.
#pragma once

#include <memory>

#include "wire/actuator/actuator_uri.hpp"
#include "wire/transport/serial_system.hpp"

namespace skyloop::inline wire {

/// Opens the device, takes RTS from flow control (CRTSCTS off) and keeps the line's level beyond the closing (HUPCL
/// off; neither is put back, which could move the line). CLOCAL is on meanwhile. Linux asserts RTS and DTR whenever a
/// tty is opened, so that an output whose active level cuts does so until restore() is called. Fails with `outside`: no
/// such device, no permission, another program holds it (flock), or it has no modem lines.
Result<std::unique_ptr<Actuator>> open_modem_line(const ModemLineAddress& address,
                                                  std::shared_ptr<SerialSystem> system);

}  // namespace skyloop::inline wire
