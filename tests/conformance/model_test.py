"""The scripted clients against the model receiver: they pass a good one and tell what is wrong with each bad one."""
import concurrent.futures
import unittest

import model_receiver
import receiver
import wire
from clients import CLIENTS
from dialogue import Failure

GOOD = [("px4", "ublox-m9", "garbage"), ("px4", "ublox-m10", "whole", "deaf_at_first"),
        ("px4", "ublox-m8", "whole"), ("ardupilot", "ublox-m10", "bytes"),
        ("ardupilot_keys", "ublox-f9p", "bursts"), ("inav", "ublox-m8", "whole"), ("betaflight", "ublox-f9p", "whole"),
        ("u_center", "ublox-m8", "whole"), ("u_center", "ublox-m10", "whole"),
        ("kumar_ros", "ublox-m8", "whole"), ("sparkfun", "ublox-m10", "whole"), ("ubloxcfg", "ublox-m9", "whole"),
        ("gpsd_probes", "ublox-m8", "whole"), ("gpsd_probes", "mtk3339", "whole"),
        ("px4_nmea", "nmea-generic", "whole"),
        ("ardupilot_nmea", "nmea-generic", "whole")]
# Client, board, what the receiver does wrong, and words of the failure.
BAD = [("px4", "ublox-m9", "twice_acked", "no acknowledgement that was not asked for"),
       ("px4", "ublox-m9", "wrong_date", "expected the date"),
       ("px4", "ublox-m9", "stray_nmea", "came     $GNRMC"),
       ("px4", "ublox-f9p", "late_acks", "within 250 ms of the request"),
       ("px4", "ublox-m9", "version_late", "a configured receiver after 3 passes"),
       ("inav", "ublox-m8", "dropped_epochs", "iTOW on the grid"),
       ("betaflight", "ublox-m9", "late_acks", "within 150 ms of the request"),
       ("ardupilot", "ublox-m8", "forgets_rates", "to read back rate"),
       ("u_center", "ublox-f9p", "late_acks", "expected ACK-ACK of CFG-PRT within"),
       ("u_center", "ublox-m9", "acks_polls", "no acknowledgement that was not asked for"),
       ("gpsd_probes", "nmea-generic", "answers_binary", "not a byte of UBX")]


def outcome(client, board, writes="whole", *faults):
    """None, or the text of the failure."""
    board = receiver.BOARDS[board]
    model = model_receiver.ModelReceiver(board, faults)
    model.start()
    line = wire.Wire(model.path, writes=writes)
    try:
        CLIENTS[client](line, board).run()
        return None
    except Failure as failure:
        return str(failure)
    finally:
        line.close()
        model.stop()


class AgainstTheModel(unittest.TestCase):
    def test_all(self):
        # Processes, since each of them spends its time waiting and wants its deadlines kept.
        with concurrent.futures.ProcessPoolExecutor(6, initializer=wire.take_priority) as pool:
            good = [(case, pool.submit(outcome, *case)) for case in GOOD]
            bad = [(case, pool.submit(outcome, case[0], case[1], "whole", case[2])) for case in BAD]
            for case, found in good:
                with self.subTest(case):
                    self.assertIsNone(found.result())
            for case, found in bad:
                with self.subTest(case):
                    self.assertIn(case[3], found.result() or "a receiver with this fault passed")


if __name__ == "__main__":
    unittest.main(verbosity=2)
