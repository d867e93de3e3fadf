/* Checks of a run of grains: packing, materials, contacts and bonds; and of keys that belong to the
 * other kind of run. */
#include "base/suggest.h"
#include "cases/check.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- the kind of the run ---- */

static cdem_status refuse(const cdem_case *cases, const char *key, const char *what,
                          const char *instead, cdem_fault *fault) {
  if (!cdem_case_given(cases, key))
    return CDEM_OK;
  return cdem_case_fail(cases, key, CDEM_INPUT, fault, "'%s' has no meaning in a run of %s; %s",
                        key, what, instead);
}

static cdem_status check_kind_grains(const cdem_case *cases, cdem_fault *fault) {
  static const char *const foreign[][2] = {
      {"materials", "materials of grains stand in 'grains: {materials: ...}'"},
      {"plane", "discs are discs; leave it out"},
      {"blocks", "grains are apart; bonds that break are in 'bonds'"},
      {"interfaces", "grains are held together by 'bonds'"},
      {"contact", "the law is 'grains.law', its numbers are in 'contacts'"},
      {"supports", "hold grains by 'walls'"},
      {"loads", "push grains by 'walls' with a velocity or a servo, or by 'gravity'"},
      {"plates", "a rigid plate is an entry of 'walls' with 'shape: plate'"},
      {"quiet", "damp waves by 'mass_damping' or 'local_damping'"}};
  for (size_t i = 0; i < sizeof foreign / sizeof *foreign; i++)
    CDEM_TRY(refuse(cases, foreign[i][0], "grains", foreign[i][1], fault));
  if (cases->values.analysis == CDEM_ANALYSIS_STATIC)
    return cdem_case_fail(cases, "analysis", CDEM_INPUT, fault,
                          "grains have no static solution: their contacts come and go; let "
                          "'analysis' be relaxation");
  return CDEM_OK;
}

static cdem_status check_kind_coupled(const cdem_case *cases, bool grains, bool mesh,
                                      cdem_fault *fault) {
  if (!grains || !mesh)
    return cdem_case_fail(
        cases, "coupling", CDEM_INPUT, fault,
        "a coupled case needs a 'mesh' with its 'materials' for the coarse medium "
        "and 'grains' with their 'contacts' for the fine one");
  if (!cdem_case_given(cases, "materials"))
    return cdem_case_fail(cases, "mesh", CDEM_INPUT, fault, "a body needs 'materials'");
  CDEM_TRY(
      refuse(cases, "cell", "grains in a body", "their surroundings are the coarse medium", fault));
  return refuse(cases, "grains.packing.compact", "grains in a body",
                "press the packing together in a run of its own, and take its grains by 'file'",
                fault);
}

cdem_status cdem_case_check_kind(const cdem_case *cases, cdem_fault *fault) {
  static const char *const foreign[][2] = {{"contacts", "contact between blocks is in 'contact'"},
                                           {"walls", "a rigid wall is an entry of 'plates'"},
                                           {"bonds", "blocks are held together by 'interfaces'"},
                                           {"cell", "a body is not periodic"}};
  bool grains = cdem_case_has_grains(cases), mesh = cdem_case_given(cases, "mesh");
  if (cdem_case_is_coupled(cases))
    return check_kind_coupled(cases, grains, mesh, fault);
  if (grains && mesh)
    return cdem_case_fail(cases, "grains", CDEM_INPUT, fault,
                          "a case has a 'mesh' or 'grains', not both, unless 'coupling' says where "
                          "in the mesh the grains are");
  if (grains)
    return check_kind_grains(cases, fault);
  for (size_t i = 0; i < sizeof foreign / sizeof *foreign; i++)
    CDEM_TRY(refuse(cases, foreign[i][0], "a body", foreign[i][1], fault));
  if (!mesh)
    return cdem_case_fail(cases, "", CDEM_INPUT, fault,
                          "a case needs a 'mesh' (a body and its 'materials') or 'grains'");
  if (!cdem_case_given(cases, "materials"))
    return cdem_case_fail(cases, "mesh", CDEM_INPUT, fault, "a body needs 'materials'");
  return CDEM_OK;
}

/* ---- materials ---- */

cdem_status cdem_case_check_grain_material(const cdem_case *cases, const char *key,
                                           const char *name, cdem_fault *fault) {
  enum { MOST = 64 };
  const cdem_case_grains *grains = &cases->values.grains;
  const char *known[MOST];
  char list[256] = "";
  int count = 0;
  for (int64_t m = 0; m < grains->materials.count; m++) {
    if (name == NULL || strcmp(grains->materials.item[m].name, name) == 0)
      return CDEM_OK;
    size_t used = strlen(list);
    if (count < MOST && used + 80 < sizeof list) {
      known[count++] = grains->materials.item[m].name;
      snprintf(list + used, sizeof list - used, "%s'%s'", used > 0 ? ", " : "", known[count - 1]);
    }
  }
  const char *near = cdem_suggest(name, known, count);
  return cdem_case_fail(cases, key, CDEM_INPUT, fault,
                        "there is no material '%s'%s%s%s grains.materials has %s", name,
                        near != NULL ? "; did you mean '" : "", near != NULL ? near : "",
                        near != NULL ? "'?" : ";", list);
}

static cdem_status check_between(const cdem_case *cases, const char *section, int64_t index,
                                 const cdem_case_texts *between, cdem_fault *fault) {
  char key[CDEM_CASE_PATH];
  cdem_case_item_key(key, section, index, "between");
  if (between->count != 0 && between->count != 2)
    return cdem_case_fail(cases, key, CDEM_INPUT, fault,
                          "'between' must name two materials, not %d; [a, a] means grains of a "
                          "among themselves",
                          (int)between->count);
  for (int64_t i = 0; i < between->count; i++)
    CDEM_TRY(cdem_case_check_grain_material(cases, key, between->item[i], fault));
  return CDEM_OK;
}

static cdem_status check_densities(const cdem_case *cases, cdem_fault *fault) {
  const cdem_case_grains *grains = &cases->values.grains;
  char key[CDEM_CASE_PATH];
  const char *name = grains->material != NULL ? grains->material : grains->materials.item[0].name;
  for (int64_t m = 0; m < grains->materials.count; m++)
    if (strcmp(grains->materials.item[m].name, name) == 0 &&
        isnan(grains->materials.item[m].density))
      return cdem_case_fail(
          cases, cdem_case_named_key(key, "grains.materials", name, ""), CDEM_INPUT, fault,
          "material '%s' of the grains needs 'density': the run moves masses", name);
  return CDEM_OK;
}

/* ---- packing ---- */

enum { EQUAL, UNIFORM, POWER, NORMAL, TABLE }; /* the choices of `sizes` */

static cdem_status needs(const cdem_case *cases, const char *name, const char *why, bool is_there,
                         cdem_fault *fault) {
  if (is_there)
    return CDEM_OK;
  return cdem_case_fail(cases, "grains.packing", CDEM_INPUT, fault, "a packing %s needs '%s'", why,
                        name);
}

static cdem_status check_sizes(const cdem_case *cases, cdem_fault *fault) {
  static const char *const why[] = {"of equal sizes", "of uniform sizes", "of power sizes",
                                    "of normal sizes", "with a table of sizes"};
  const cdem_case_packing *p = &cases->values.grains.packing;
  const char *of = why[p->sizes];
  bool drawn = p->sizes == UNIFORM || p->sizes == POWER || p->sizes == NORMAL;
  if (p->sizes == EQUAL || p->sizes == NORMAL)
    CDEM_TRY(needs(cases, "radius", of, !isnan(p->radius), fault));
  if (drawn)
    CDEM_TRY(needs(cases, "least", of, !isnan(p->least), fault));
  if (drawn)
    CDEM_TRY(needs(cases, "most", of, !isnan(p->most), fault));
  if (p->sizes == POWER)
    CDEM_TRY(needs(cases, "exponent", of, !isnan(p->exponent), fault));
  if (p->sizes == NORMAL)
    CDEM_TRY(needs(cases, "spread", of, !isnan(p->spread), fault));
  if (p->sizes == TABLE)
    CDEM_TRY(needs(cases, "classes", of, p->classes.count > 0, fault));
  if (drawn && !(p->least <= p->most))
    return cdem_case_fail(cases, "grains.packing.most", CDEM_INPUT, fault,
                          "'most' is %g m and must be at least 'least', %g m", p->most, p->least);
  return CDEM_OK;
}

static cdem_status check_packing(const cdem_case *cases, cdem_fault *fault) {
  const cdem_case_packing *p = &cases->values.grains.packing;
  char key[CDEM_CASE_PATH];
  for (int k = 0; k < cases->values.grains.dimension; k++) {
    snprintf(key, sizeof key, "grains.packing.high[%d]", k);
    if (!(p->high[k] > p->low[k]))
      return cdem_case_fail(cases, key, CDEM_INPUT, fault,
                            "the box of a packing needs 'high' above 'low' in each direction; "
                            "along %c 'high' is %g m and 'low' %g m",
                            "xyz"[k], p -> high[k], p -> low[k]);
  }
  CDEM_TRY(cdem_case_check_directions(cases, "grains.packing.periodic", &p->periodic, fault));
  CDEM_TRY(check_sizes(cases, fault));
  CDEM_TRY(cdem_case_check_exclusive(cases, "grains.packing", "count", "fraction", fault));
  CDEM_TRY(
      cdem_case_check_exclusive(cases, "grains.packing.compact", "fraction", "pressure", fault));
  CDEM_TRY(cdem_case_check_exclusive(cases, "grains.packing.compact", "fraction", "height", fault));
  CDEM_TRY(cdem_case_check_exclusive(cases, "grains.packing.compact", "pressure", "height", fault));
  if (cdem_case_given(cases, "grains.packing.compact") && isnan(p->compact.fraction) &&
      isnan(p->compact.pressure) && isnan(p->compact.height))
    return cdem_case_fail(cases, "grains.packing.compact", CDEM_INPUT, fault,
                          "'compact' needs 'fraction', 'pressure' or, in a cylinder, 'height'");
  return CDEM_OK;
}

/* ---- bonds and contacts ---- */

static cdem_status check_bond(const cdem_case *cases, int64_t i, cdem_fault *fault) {
  const cdem_case_bond *bond = &cases->values.bonds.item[i];
  char key[CDEM_CASE_PATH];
  CDEM_TRY(check_between(cases, "bonds", i, &bond->between, fault));
  if (cases->values.grains.dimension == 2 && bond->twisting_stiffness > 0.0)
    return cdem_case_fail(cases, cdem_case_item_key(key, "bonds", i, "twisting_stiffness"),
                          CDEM_INPUT, fault,
                          "discs do not twist: 'twisting_stiffness' has a meaning in 3-D only");
  return CDEM_OK;
}

/* ---- pictures ---- */

static cdem_status check_pictures(const cdem_case *cases, cdem_fault *fault) {
  static const char *const names[] = {"radius",
                                      "speed",
                                      "displacement",
                                      "rotation",
                                      "pressure",
                                      "effective_stress",
                                      "volumetric_strain",
                                      "effective_strain",
                                      "contacts",
                                      "chains",
                                      "velocities"};
  const cdem_case_grains *g = &cases->values.grains;
  const double(*ends)[2] = (const double(*)[2]) & g->picture_ranges;
  char key[CDEM_CASE_PATH];
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    cdem_case_named_key(key, "grains.picture_ranges", names[i], "");
    if (cdem_case_given(cases, key) && !(ends[i][0] < ends[i][1]))
      return cdem_case_fail(cases, key, CDEM_INPUT, fault,
                            "a colour bar from %g to %g: the second end must be above the first",
                            ends[i][0], ends[i][1]);
  }
  for (int i = 0; i < CDEM_CASE_PICTURE_TIMES; i++)
    if (g->picture_times[i] < 0.0)
      return cdem_case_fail(cases, cdem_case_item_key(key, "grains.picture_times", i, ""),
                            CDEM_INPUT, fault, "a picture at %g s, before the start of the run",
                            g->picture_times[i]);
  return CDEM_OK;
}

/* ---- fields ---- */

static cdem_status check_fields(const cdem_case *cases, cdem_fault *fault) {
  const cdem_case_fields *f = &cases->values.grains.fields;
  char key[CDEM_CASE_PATH];
  double points = 1.0;
  for (int k = 0; k < cases->values.grains.dimension; k++) {
    snprintf(key, sizeof key, "grains.fields.high[%d]", k);
    if (!(f->low[k] <= f->high[k]))
      return cdem_case_fail(cases, key, CDEM_INPUT, fault,
                            "fields from %g to %g m along %c: 'high' must not be below 'low'",
                            f->low[k], f->high[k], "xyz"[k]);
    snprintf(key, sizeof key, "grains.fields.count[%d]", k);
    if (!(f->count[k] >= 1.0 && f->count[k] <= 1e6 && f->count[k] == floor(f->count[k])))
      return cdem_case_fail(cases, key, CDEM_INPUT, fault,
                            "%g points of the fields along %c; they are counted by whole numbers "
                            "from 1 to 1000000",
                            f->count[k], "xyz"[k]);
    points *= f->count[k];
  }
  if (points > CDEM_CASE_FIELD_POINTS)
    return cdem_case_fail(cases, "grains.fields.count", CDEM_INPUT, fault,
                          "%g points of the fields; at most %d are possible", points,
                          CDEM_CASE_FIELD_POINTS);
  if (cases->values.grains.dimension == 2 && f->count[2] > 1.0)
    return cdem_case_fail(cases, "grains.fields.count[2]", CDEM_INPUT, fault,
                          "discs move in the plane z = 0: their fields have one layer, not %g",
                          f->count[2]);
  return CDEM_OK;
}

/* ---- grains that deform ---- */

enum {
#define X(name) SHAPE_##name,
#include "fdem/shapes.def"
#undef X
};
static const char *const law_names[] = {
#define X(identifier, name) name,
#include "dem/laws.def"
#undef X
};

static cdem_status check_deformable(const cdem_case *cases, cdem_fault *fault) {
  static const char *const rigid[][2] = {
      {"bonds", "their contacts only push"},
      {"cell", "they do not know periodic cells"},
      {"probes", "the columns of their history hold pushes, fabric and stress anyway"},
      {"grains.fields", "they are averaged over rigid grains"},
      {"grains.pictures", "frames show them, and the distribution of pushes is drawn anyway"},
      {"grains.rolling", "their faces resist it"},
      {"grains.twisting", "their faces resist it"},
      {"local_damping", "damp them by 'mass_damping' or 'grains.deformable.damping_ratio'"}};
  const cdem_case_grains *g = &cases->values.grains;
  bool mesh = g->deformable.shape == SHAPE_mesh;
  for (size_t i = 0; i < sizeof rigid / sizeof *rigid; i++)
    CDEM_TRY(refuse(cases, rigid[i][0], "deformable grains", rigid[i][1], fault));
  if (g->dimension != 3)
    return cdem_case_fail(cases, "grains.deformable", CDEM_INPUT, fault,
                          "deformable grains are solids: 'dimension' must be 3");
  if (strcmp(law_names[g->law], "penalty") != 0)
    return cdem_case_fail(cases, "grains.law", CDEM_INPUT, fault,
                          "deformable grains touch by nodes: their law must be 'penalty', not '%s'",
                          law_names[g->law]);
  if (mesh != (g->deformable.file != NULL))
    return cdem_case_fail(cases, "grains.deformable", CDEM_INPUT, fault,
                          "'shape: mesh' and 'file' belong together: give both or none");
  if (cdem_case_is_triaxial(cases) && cases->values.triaxial.boundary == CDEM_TRIAXIAL_CYLINDER)
    return cdem_case_fail(cases, "triaxial.boundary", CDEM_INPUT, fault,
                          "a specimen of deformable grains has a membrane around it; a cylinder "
                          "with a servo knows rigid grains only");
  return CDEM_OK;
}

cdem_status cdem_case_check_grains(const cdem_case *cases, cdem_fault *fault) {
  const cdem_case_values *v = &cases->values;
  bool file = v->grains.file != NULL, packing = cdem_case_given(cases, "grains.packing");
  if (v->grains.materials.count == 0)
    return cdem_case_fail(cases, "grains.materials", CDEM_INPUT, fault, "grains need a material");
  if (file && packing)
    return cdem_case_fail(cases, "grains.packing", CDEM_INPUT, fault,
                          "grains come from a file or a packing, not both; leave out 'file' or "
                          "'packing'");
  if (!file && !packing)
    return cdem_case_fail(cases, "grains", CDEM_INPUT, fault,
                          "grains need a 'file' or a 'packing'");
  if (packing)
    CDEM_TRY(check_packing(cases, fault));
  CDEM_TRY(cdem_case_check_grain_material(cases, "grains.material", v->grains.material, fault));
  if (packing) /* a table may name others */
    CDEM_TRY(check_densities(cases, fault));
  if (v->grains.dimension == 2 && v->gravity[2] != 0.0)
    return cdem_case_fail(cases, "gravity[2]", CDEM_INPUT, fault,
                          "discs move in the plane z = 0: gravity along z is %g m/s2 and must be "
                          "left out",
                          v->gravity[2]);
  if (cdem_case_has_deformable(cases))
    CDEM_TRY(check_deformable(cases, fault));
  if (v->contacts.count == 0)
    return cdem_case_fail(cases, cdem_case_given(cases, "contacts") ? "contacts" : "grains",
                          CDEM_INPUT, fault,
                          "grains need 'contacts': the numbers of their law; `cdem list laws` says "
                          "which words it wants");
  for (int64_t i = 0; i < v->contacts.count; i++)
    CDEM_TRY(check_between(cases, "contacts", i, &v->contacts.item[i].between, fault));
  for (int64_t i = 0; i < v->bonds.count; i++)
    CDEM_TRY(check_bond(cases, i, fault));
  if (cdem_case_given(cases, "grains.fields"))
    CDEM_TRY(check_fields(cases, fault));
  return check_pictures(cases, fault);
}
