#include "board.h"
#include "driver.h"

int main(void) {
    report_text("begin");
    report_end();
    drive();
}
