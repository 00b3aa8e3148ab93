"""The words of the segmentation network: parts, kinds, landmarks, ways limbs lie.

Lists only; an index into a list is the number stored in pictures and truth.
Left and right mean the side of the picture.
"""

PARTS = ["ground", "body", "sleeve_left", "sleeve_right", "leg_left",
         "leg_right", "hood", "collar", "inside", "waistband", "hanger"]

KINDS = ["tshirt", "polo", "longsleeve", "shirt", "sleeveless", "dress",
         "skirt", "trousers", "shorts", "jacket", "hoodie", "onepiece"]

LANDMARKS = ["neck_left", "neck_right", "neck_front", "shoulder_left",
             "shoulder_right", "armpit_left", "armpit_right",
             "cuff_left_outer", "cuff_left_inner", "cuff_right_outer",
             "cuff_right_inner", "waist_left", "waist_right", "fork",
             "hem_left", "hem_right", "leg_left_outer", "leg_left_inner",
             "leg_right_outer", "leg_right_inner"]

LIES = ["absent", "apart", "beside", "over", "folded"]

LIMBS = ["sleeve_left", "sleeve_right", "leg_left", "leg_right"]
