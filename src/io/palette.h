/* Private to io: colours of maps. Both palettes are paths through Oklab (Ottosson 2020, "A
 * perceptual color space for image processing"), in which equal steps look equal: one of ever
 * growing lightness from dark blue over green to yellow, and one from blue over near white to red
 * whose ends are equally dark. They stay readable in grey print and for colour-blind eyes. */
#ifndef CDEM_IO_PALETTE_H
#define CDEM_IO_PALETTE_H

#include <stdbool.h>
#include <stdint.h>

/* 0xRRGGBB of a place 0..1 (clamped) of a palette; grey for NaN. shade: brightness 0..1. */
uint32_t cdem_palette_colour(bool diverging, double place, double shade);

#endif
