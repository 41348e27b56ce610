/* Reads the image of one part into variables.
   SPDX-License-Identifier: Apache-2.0 */

#include "lathe/part.h"
#include "link/protocol.h" /* image layout */
#include "store/flash.h"   /* reading numbers */
#include "store/parts.h"   /* where the image is */

int16_t part_stock_radius;
int16_t part_stock_length;
int16_t part_stock_front;
uint16_t part_depth_of_cut;
uint16_t part_allowance;
uint16_t part_retract;
uint8_t part_operations;

uint16_t part_record;
uint8_t part_type;
uint8_t part_size;
uint16_t part_flags;
int16_t part_low;
int16_t part_high;
int16_t part_x;

void part_reopen(uint8_t slot)
{
    parts_open(slot);
}

/* The fields follow each other in the image: see link/protocol.toml. */
void part_open(uint8_t slot)
{
    parts_open(slot);
    parts_seek(PART_IMAGE_OPERATION_COUNT_AT);
    part_operations = flash_read();
    parts_seek(PART_IMAGE_STOCK_RADIUS_AT);
    part_stock_radius = flash_read_i16();
    part_stock_length = flash_read_i16();
    part_stock_front = flash_read_i16();
    part_depth_of_cut = flash_read_u16();
    part_allowance = flash_read_u16();
    parts_seek(PART_IMAGE_RETRACT_AT);
    part_retract = flash_read_u16();
}

void part_read_operation(void)
{
    parts_seek(part_record);
    part_type = flash_read();
    part_size = flash_read();
    part_flags = flash_read_u16();
    part_high = part_stock_front;
    if (part_type != OPERATION_FACE) {
        part_high = flash_read_i16();
    }
    part_low = flash_read_i16();
    part_x = flash_read_i16();
}

void part_first(void)
{
    part_record = PART_IMAGE_HEADER_SIZE;
    part_read_operation();
}

void part_next(void)
{
    part_record += part_size;
    part_read_operation();
}

uint32_t part_feed(void)
{
    parts_seek(PART_IMAGE_FEED_AT);
    return flash_read_u32();
}

uint32_t part_finish_feed(void)
{
    parts_seek(PART_IMAGE_FINISH_FEED_AT);
    return flash_read_u32();
}
