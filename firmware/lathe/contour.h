/*
 * Contour: what the operations of a part leave of the stock, asked level by
 * level.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * A contour is a chain of lines and arcs towards the chuck: one radius C for
 * every z, a shoulder being a line with dz = 0. Nothing of it is kept in RAM;
 * every question walks along the records in flash.
 *
 *     x                  stretch at level v: where C <= v
 *     |      ____            |<---->|   s = its end nearest to the free end
 *   v |-----/----\-----------e------s-  e = its other end
 *     |    /      \________/         \
 *     +------------------------------- z
 *
 * All results lie on the safe side: a stretch may be told up to a step too
 * short on a slope (two on an arc, and a level too high), never too long.
 *
 * Main loop only, with the part opened (lathe/part.h). A walk takes about 25
 * us per line and 60 us per arc.
 */
#ifndef CONTOUR_H
#define CONTOUR_H

#include <stdint.h>

/* Offset of the record of the present operation; those before it have been
   cut. Set by the caller. */
extern uint16_t contour_own;

/* The piece of a chain read last, lines and arcs without an extremum of x:
   start and end; the arc's radius squared, its start from the centre, and
   the end of the whole arc from there. */
extern int16_t contour_zs;
extern int16_t contour_xs;
extern int16_t contour_ze;
extern int16_t contour_xe;
extern uint8_t contour_arc; /* SEGMENT_ARC_..., 0 = line */
extern uint32_t contour_square;
extern int16_t contour_from_z;
extern int16_t contour_from_x;
extern int16_t contour_to_z;
extern int16_t contour_to_x;

/* The segment that it belongs to, as it is stored. */
extern int16_t contour_dz;
extern int16_t contour_dx;
extern uint16_t contour_at; /* offset of the segment behind it */

/* The piece is the first half of an arc that goes on behind its extremum. */
extern uint8_t contour_split;

/* Bytes of a segment of the kind in contour_arc. */
uint8_t contour_size(void);

/* Starts at the chain of the record at part_record, a CONTOUR or PLUNGE;
   its start is then in contour_ze and contour_xe. */
void contour_open(void);

/* Reads the next piece; 0 at the end of the chain. */
uint8_t contour_next(void);

/* Reads the centre of the arc just read into path_next. */
void contour_read_centre(void);

/* Square of a distance. */
uint32_t contour_squared(int16_t distance);

/* The result of contour_stretch(); _contains: it begins in front of z. */
extern int16_t contour_s;
extern int16_t contour_e;
extern uint8_t contour_contains;

/* The first stretch at level v of the present operation that ends behind z,
   cut off at z. Returns 0 when there is none. */
uint8_t contour_stretch(int16_t v, int16_t z);

/* Where, at z or behind, the material larger than v begins that the
   operations before the present one have left; below every z: nowhere. */
int16_t contour_material(int16_t v, int16_t z);

#endif
