/* Clothes on moving figures of ellipsoids in real time.
 *
 * Lengths are metres, times seconds; Y is up. A character and its garments belong to one thread at a
 * time. Nothing is allocated but by functions that return a pointer. Where one fails it returns NULL,
 * or 0 for a number, and writes what is wrong into the message, if one is given. */
#ifndef TOILE_REALTIME_H
#define TOILE_REALTIME_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct toile_character toile_character;
typedef struct toile_garment toile_garment;

/* Room for a message that ends with 0; longer ones are cut. */
typedef struct {
    char *text;
    size_t room;
} toile_message;

/* A character of the text of a character file, at rest. Freed by toile_character_free. */
toile_character *toile_character_read(const char *json, size_t length, toile_message message);
void toile_character_free(toile_character *character);

/* Starts the clip of a name that ends with 0, faded into within some time. 1 if there is one. */
int toile_character_start(toile_character *character, const char *clip, float fade,
                          toile_message message);
/* Stops: the pose stays as it is. */
void toile_character_stop(toile_character *character);
/* Goes on by some time and poses the ellipsoids. */
void toile_character_advance(toile_character *character, float dt);
/* From an ellipsoid's axes to the world: three rows of a rotation, each with its shift. 1 if there is
 * such an ellipsoid. */
int toile_character_transform(const toile_character *character, size_t ellipsoid, float rows[12]);

/* A garment that lies over the character as it is now: x, y, z of each vertex, three vertices of each
 * triangle, the distance of its layer from the ellipsoids. Freed by toile_garment_free. */
toile_garment *toile_garment_new(const toile_character *character, const float *positions,
                                 size_t vertices, const uint32_t *triangles, size_t triangle_count,
                                 float offset, toile_message message);
void toile_garment_free(toile_garment *garment);

/* Once a frame, after the character was advanced: the garment hangs, or fits closely. */
void toile_garment_adjust_by_gravity(toile_garment *garment, const toile_character *character,
                                     float dt);
void toile_garment_adjust_by_shape(toile_garment *garment, const toile_character *character,
                                   float dt);
/* Writes x, y, z of each vertex: as often as is liked. */
void toile_garment_positions(const toile_garment *garment, float *positions);

#ifdef __cplusplus
}
#endif

#endif
