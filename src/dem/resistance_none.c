#include "dem/law.h"

const cdem_resistance cdem_rolling_none = {.name = "none", .help = "Grains roll freely."};
const cdem_resistance cdem_twisting_none = {.name = "none", .help = "Grains twist freely."};
