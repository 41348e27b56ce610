/* Reads what a part says once, or for all records behind: header, tool, cutting
   data.
   SPDX-License-Identifier: Apache-2.0 */

#include "lathe/part.h"
#include "link/protocol.h" /* image layout */
#include "store/flash.h"   /* reading numbers */
#include "store/parts.h"   /* where the image is */

int16_t part_stock_radius;
int16_t part_stock_length;
int16_t part_stock_front;
int16_t part_retract;
uint8_t part_operations;

uint16_t part_below;
uint16_t part_width;
uint16_t part_back;
uint16_t part_front;
int16_t part_offset_x;
int16_t part_offset_z;
uint8_t part_spring;
uint16_t part_depth_of_cut;
uint16_t part_allowance;
uint16_t part_feed;
uint16_t part_finish_feed;
uint16_t part_spindle;
uint16_t part_peck;

/* The fields follow each other in the image: see link/protocol.toml. */
void part_open(uint16_t length)
{
    part_length = length;
    parts_seek(PART_IMAGE_OPERATION_COUNT_AT);
    part_operations = flash_read();
    parts_seek(PART_IMAGE_STOCK_RADIUS_AT);
    part_stock_radius = flash_read_u16();
    part_stock_length = flash_read_u16();
    part_stock_front = flash_read_u16();
    part_retract = flash_read_u16();
}

void part_apply(void)
{
    if (part_type == OPERATION_TOOL) {
        parts_seek(part_record + OPERATION_TOOL_BELOW_AT);
        part_below = flash_read_u16();
        part_width = flash_read_u16();
        part_back = flash_read_u16();
        part_front = flash_read_u16();
        part_offset_x = flash_read_u16();
        part_offset_z = flash_read_u16();
    } else {
        part_spring = part_kind;
        part_depth_of_cut = flash_read_u16();
        part_allowance = flash_read_u16();
        part_feed = flash_read_u16();
        part_finish_feed = flash_read_u16();
        part_spindle = flash_read_u16();
        part_peck = flash_read_u16();
    }
}
