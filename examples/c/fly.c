/* fly: a receiver on a vehicle that this program flies, and its bytes on standard output.
 *
 *   cc -std=c11 fly.c $(pkg-config --cflags --libs skyloop) -lm -o fly
 *   ./fly SECONDS [scenario.toml] >port0.ubx
 *
 * The vehicle goes round in a circle of 100 m at 10 m/s. What a simulator does in each step of its physics is in main().
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <skyloop.h>

static const double radius_m = 100, speed_mps = 10;

static void say(void *user, int32_t level, const char *sentence) {
    (void)user;
    if (level <= SKY_LOG_WARNING) fprintf(stderr, "fly: %s\n", sentence);
}

static int fail(sky_emulator *receiver, const char *call, int64_t status) {
    char sentence[512] = "";
    sky_last_error(receiver, sentence, sizeof sentence);
    fprintf(stderr, "fly: %s gave %lld: %s\n", call, (long long)status, sentence);
    sky_destroy(receiver);
    return 1;
}

/* Where the vehicle is, relative to the origin: north, east, down. */
static sky_truth truth_at(int64_t now_ns) {
    sky_truth truth = {0};
    const double turned = speed_mps / radius_m * 1e-9 * (double)now_ns; /* rad */
    truth.struct_size = sizeof truth;
    truth.fields = SKY_POS_LOCAL_NED | SKY_VEL | SKY_ACC;
    truth.sim_time_ns = now_ns;
    truth.pos[0] = radius_m * cos(turned);
    truth.pos[1] = radius_m * sin(turned);
    truth.vel_ned[0] = -speed_mps * sin(turned);
    truth.vel_ned[1] = speed_mps * cos(turned);
    truth.acc_ned[0] = -speed_mps * speed_mps / radius_m * cos(turned);
    truth.acc_ned[1] = -speed_mps * speed_mps / radius_m * sin(turned);
    return truth;
}

/* What has left the receiver's first port by now. */
static int64_t drain(sky_emulator *receiver) {
    unsigned char bytes[4096];
    int64_t count = 0;
    while ((count = sky_read(receiver, 0, bytes, sizeof bytes)) > 0)
        if (fwrite(bytes, 1, (size_t)count, stdout) != (size_t)count) return SKY_E_IO;
    return count;
}

int main(int count, char **words) {
    const int64_t step_ns = 20 * 1000000; /* 50 steps a second */
    const double seconds = count > 1 ? atof(words[1]) : 10;
    char why[512] = "";
    sky_create_info info = {0};
    sky_emulator *receiver = NULL;
    int64_t now_ns = 0;
    sky_status status = SKY_OK;

    info.struct_size = sizeof info;
    info.abi_major = SKY_ABI_MAJOR;
    info.set = SKY_CREATE_SEED;
    info.seed = 7;
    info.scenario_file = count > 2 ? words[2] : NULL;
    info.start_utc = "2026-03-01T12:00:00Z";
    info.log = say;
    info.error = why;
    info.error_capacity = sizeof why;
    status = sky_create(&info, &receiver);
    if (status != SKY_OK) {
        fprintf(stderr, "fly: sky_create gave %d: %s\n", (int)status, why);
        return 1;
    }
    for (now_ns = 0; now_ns <= (int64_t)(seconds * 1e9); now_ns += step_ns) {
        const sky_truth truth = truth_at(now_ns);
        int64_t drained = 0;
        status = sky_set_truth(receiver, &truth);
        if (status != SKY_OK) return fail(receiver, "sky_set_truth", status);
        status = sky_advance(receiver, now_ns, NULL);
        if (status != SKY_OK) return fail(receiver, "sky_advance", status);
        drained = drain(receiver);
        if (drained < 0) return fail(receiver, "sky_read", drained);
    }
    {
        sky_fix fix;
        memset(&fix, 0, sizeof fix);
        fix.struct_size = sizeof fix;
        status = sky_get_fix(receiver, 0, &fix);
        if (status != SKY_OK) return fail(receiver, "sky_get_fix", status);
        fprintf(stderr, "fly: %llu epochs, fix %d, %d satellites, %.7f %.7f, error %.2f m east, %.2f m north\n",
                (unsigned long long)fix.epochs, fix.type, fix.satellites_used, fix.lat_deg, fix.lon_deg,
                fix.error_enu_m[0], fix.error_enu_m[1]);
    }
    sky_destroy(receiver);
    return 0;
}
